#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/proximity/placed_mesh.h"

namespace nearfit {

/// The pieces of a mesh: triangles connected through edges.
struct MeshPieces {
  std::vector<std::uint32_t> pieceOf;        ///< By triangle.
  std::vector<std::uint32_t> firstTriangle;  ///< By piece.
  /// By piece: along each edge as many triangles run one way as the other, so that it winds around every
  /// point off it a whole number of times.
  std::vector<bool> isClosed;
};
MeshPieces piecesOf(const TriangleMesh& mesh);

/// What the closed pieces of a placed mesh enclose.
class PlacedSolid {
 public:
  /// @param mesh, pieces  Kept by reference.
  PlacedSolid(const PlacedMesh& mesh, const MeshPieces& pieces);

  /// Whether the closed pieces wind around a point, which must lie on none of their triangles. Decided
  /// exactly, by the triangles that a ray passes through.
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
  const MeshPieces& pieces_;
  Aabb box_;  ///< Of the closed pieces, as placed.
};

}  // namespace nearfit
