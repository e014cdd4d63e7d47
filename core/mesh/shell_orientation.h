#pragma once

#include <cstdint>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Triangles of a mesh, flipped so that closed components are outside out.
struct OrientedShells {
  std::vector<Triangle> triangles;  ///< In the mesh's order, flipped where needed.
  /// Components (connected through edges) that are closed, oriented and have a volume.
  std::uint32_t closedPieces = 0;
  std::uint32_t turnedPieces = 0;  ///< Number of those that were flipped.
};

/// Flips all closed components if their total volume is negative. Then flips each closed component of
/// negative volume that lies in no other closed component's bounding box (one that does is taken for a
/// cavity). Open, non-manifold or inconsistent components have no inside and stay as they are. About O(n);
/// with more than 5,000 closed components, only the first step runs.
OrientedShells orientShells(const TriangleMesh& mesh);

}  // namespace nearfit
