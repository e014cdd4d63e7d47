#pragma once

#include <cstdint>
#include <vector>

#include "core/math/aabb.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// A component of a mesh, as a shell.
struct MeshShell {
  std::uint32_t firstTriangle = 0;  ///< One of its triangles.
  std::uint32_t triangles = 0;      ///< Number of its triangles.
  /// Every edge has two faces, which agree on the outside, and it encloses a volume beyond rounding.
  bool isSolid = true;
  double volume = 0.0;  ///< Signed [m^3]; 0 unless isSolid.
  Aabb box;             ///< [m]
  /// Number of other solid shells around it, whatever way they face. Even: its outside is where it should be if its
  /// volume is positive. Odd: it is a cavity, whose volume should be negative. 0 unless isSolid.
  std::uint32_t depth = 0;

  /// True if it faces the wrong way.
  bool isInverted() const noexcept { return isSolid && (volume > 0.0) != (depth % 2 == 0); }
};

/// The components of a mesh (triangles connected through edges), numbered by their first triangles.
struct MeshShells {
  std::vector<MeshShell> shells;
  std::vector<std::uint32_t> shellOf;  ///< By triangle.
  /// False if there were too many shells to compare all: the smallest then count as facing the right way.
  bool isDepthExact = true;
};

/// Finds the shells of a mesh, and which lie within which: by the triangles that rays from some of its points cross,
/// decided exactly. A shell that crosses another counts as within it only if all these points are. O(n) for few shells
/// within the boxes of others; at most a second beyond that.
MeshShells shellsOf(const TriangleMesh& mesh);

}  // namespace nearfit
