#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/flat_groups.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Straight stretch of the outline of flats, between kept vertices.
struct OutlineSegment {
  /// Max number of triangles at an edge in the middle of a segment. Where more meet, all vertices are kept.
  static constexpr std::size_t kMaxTriangles = 4;

  std::array<std::uint32_t, 2> ends;  ///< Mesh vertices.
  /// Flats of the triangles that meet there, in ascending order; the rest is kNoFlat. A flat is there twice if it
  /// is on both sides, as at a crack.
  std::array<std::uint32_t, kMaxTriangles> flats;
};

/// Outlines of the flats of a mesh, without the vertices that say nothing: those inside a flat, and those in the
/// middle of a straight edge between two flats.
struct FlatOutlines {
  std::vector<bool> isKept;  ///< By vertex. All vertices of triangles of no flat are kept.
  std::vector<OutlineSegment> segments;
  /// Kept vertices inside a flat, and that flat.
  std::vector<std::array<std::uint32_t, 2>> inner;
  double deviation = 0.0;  ///< Max distance of a dropped vertex in a chain from its segment [m].
};

/// Finds the outlines. Two flats that meet get the same segments. About O(n log n); allocates.
/// @param tolerance  Max distance of a dropped vertex from its segment [m]; >= 0.
/// @param isPinned   By flat: all its vertices are kept.
FlatOutlines findOutlines(const TriangleMesh& mesh, const FlatGroups& groups, double tolerance,
                          const std::vector<bool>& isPinned);

}  // namespace nearfit
