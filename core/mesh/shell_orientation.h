#pragma once

#include <cstdint>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Faces of a mesh turned so that closed pieces are outside out.
struct OrientedShells {
  std::vector<Triangle> triangles;  ///< As in the mesh, in the same order, turned where needed.
  std::uint32_t closedPieces = 0;   ///< Pieces (connected through edges) that are closed and oriented.
  std::uint32_t turnedPieces = 0;   ///< Those of them that were turned.
};

/// A closed mesh of negative volume is turned as a whole; then each closed piece of negative volume that lies
/// in no other closed piece's bounding box. (One that does is taken for a cavity.) Pieces that are open,
/// non-manifold or inconsistent have no inside and are left alone. Near O(n); with very many pieces only the
/// whole is turned.
OrientedShells orientShells(const TriangleMesh& mesh);

}  // namespace nearfit
