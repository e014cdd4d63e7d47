#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit::test::exact {

/// Numbers are rational; intervals decide while they can.
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Number = Kernel::FT;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;

/// To the nearest double or its neighbour.
double nearest(const Number& x);
glm::dvec3 nearest(const Vector& v);
/// Length to a few roundings.
double lengthOf(const Vector& v);

/// Generator of a tangent cone besides the feature's own span.
struct Tangent {
  Vector vector;
  double length;  ///< Of `vector`: of an edge, or the height of a face over an edge.
};

/// A vertex, edge or face with the generators of its tangent cone, in the scene's frame.
struct Feature {
  char kind;
  std::vector<Point> corners;  ///< 1, 2 or 3.
  std::vector<Tangent> tangents;
  Vector span;           ///< Of an edge its direction, of a face its normal: outward, not unit.
  double height = 0.0;   ///< Of a face over its longest side; of an edge its length.
  bool hasSide = false;  ///< Whether outside is known: two consistent faces an edge, one closed fan a vertex.
  double convexity = 0.0;   ///< Of an edge with a side: sine of its bend, positive if convex.
  bool isFolded = false;    ///< Of an edge with a side: its faces are less than a right angle apart.
  glm::dvec3 outward{0.0};  ///< Rough mean normal; decides sides where conditions are not all strict.
  std::vector<std::array<Vector, 2>> fan;  ///< Of a vertex with a side: the edges of each face, in its sense.
  glm::dvec3 lower, upper;                 ///< Box, to rounding.
};

/// A mesh's adjacency, found anew, and its features in any pose.
class Body {
 public:
  explicit Body(const TriangleMesh& mesh);

  /// All features but those without extent, moved by the exact rotation of the pose's quaternion.
  std::vector<Feature> features(const RigidTransform& pose) const;
  double size() const { return size_; }

 private:
  struct EdgeTopology {
    std::uint32_t v0, v1;
    std::vector<std::uint32_t> faces;
    bool isConsistent;
  };
  struct VertexTopology {
    std::uint32_t vertex;
    std::vector<std::uint32_t> neighbours, faces;
    bool isClosedFan;
  };
  class Posed;

  std::vector<glm::dvec3> positions_;
  std::vector<Triangle> triangles_;
  std::vector<EdgeTopology> edges_;
  std::vector<VertexTopology> vertices_;
  double size_ = 0.0;
};

}  // namespace nearfit::test::exact
