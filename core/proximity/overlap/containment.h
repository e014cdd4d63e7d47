#pragma once

#include <cstdint>
#include <mutex>
#include <vector>

#include <glm/vec3.hpp>

#include "core/proximity/overlap/placed_mesh.h"

namespace nearfit {

/// Components of a mesh: triangles connected through edges.
struct MeshComponents {
  std::vector<std::uint32_t> pieceOf;        ///< Component of each triangle.
  std::vector<std::uint32_t> firstTriangle;  ///< A triangle of each component.
  /// True for each component in which as many triangles run one way along each edge as the other, so that it
  /// winds around every point off it a whole number of times.
  std::vector<bool> isClosed;
  Aabb closedBox;  ///< Of those, in the mesh's frame [m]; empty if there are none.
};
/// Finds the components of a mesh. O(n).
MeshComponents piecesOf(const TriangleMesh& mesh);

/// Components of one mesh, found when first needed. Thread-safe: one thread searches, others wait for it.
class ComponentsOnDemand {
 public:
  /// piecesOf() the mesh; it must be the same mesh in each call.
  const MeshComponents& of(const TriangleMesh& mesh) {
    std::call_once(once_, [&] { components_ = piecesOf(mesh); });
    return components_;
  }

 private:
  std::once_flag once_;
  MeshComponents components_;
};

/// Solid that the closed components of a placed mesh enclose.
class PlacedSolid {
 public:
  /// @param mesh, pieces  Kept by reference. O(1).
  PlacedSolid(const PlacedMesh& mesh, const MeshComponents& pieces);

  /// True if the closed components wind around a point in the pose's frame, which must lie on none of their
  /// triangles. Decided exactly, by the triangles that a ray crosses. Allocates.
  bool contains(const glm::dvec3& point) const;

 private:
  struct Count {
    int windings = 0;
    bool isClear = true;
  };
  Count countAlong(const glm::dvec3& from, const glm::dvec3& to) const;
  void countTriangle(std::uint32_t triangle, const glm::dvec3& from, const glm::dvec3& to,
                     Count& count) const;

  const PlacedMesh& mesh_;
  const MeshComponents& pieces_;
  Aabb box_;  ///< Holds the closed components, as placed.
};

}  // namespace nearfit
