#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

/// Whether a segment passes through a surface, by brute force over all triangles. Points are rounded to a
/// grid, and sides of planes decided there in whole numbers: exact.
namespace nearfit::test {

/// A point in units of the grid.
struct GridPoint {
  std::int64_t x, y, z;
};
/// @param p  Within 4 units of the origin.
GridPoint toGrid(const glm::dvec3& p);

enum class Passage {
  Free,
  Blocked,
  Marginal,  ///< Something lies within the tolerance of the segment, or it meets a triangle near its edge.
};

class PassageOracle {
 public:
  /// @param sceneFromBody  Where the mesh is.
  PassageOracle(const TriangleMesh& mesh, const RigidTransform& sceneFromBody);

  /// The open segment from p to q against this surface; what is within twice the tolerance of its ends does
  /// not count.
  Passage passage(const glm::dvec3& p, const glm::dvec3& q, double tolerance) const;

  /// Whether the two surfaces meet: an edge of one passes through a face of the other.
  bool meets(const PassageOracle& other) const;

 private:
  struct Corners {
    glm::dvec3 points[3];
    GridPoint grid[3];
  };
  std::vector<Corners> triangles_;
};

}  // namespace nearfit::test
