#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/triangle_corners.h"
#include "core/proximity/box_pairs.h"
#include "core/proximity/containment.h"

namespace nearfit {

/// Two triangles of a piece.
using CrossingPair = std::array<std::uint32_t, 2>;

TriangleCorners cornersOf(const TriangleMesh& mesh, std::uint32_t triangle);

/// The boxes of all triangles, ready to be asked.
BoxPairs boxesOfTriangles(const TriangleMesh& mesh);

/// Where pieces pass through or touch themselves: all pairs of triangles of one piece that have more in
/// common than the corners that they share, in order. Decided exactly. Pieces that meet each other do not
/// count.
///
/// @param boxes  As boxesOfTriangles() makes them.
/// None where too many boxes of triangles overlap, more than a hundred for each and a hundred million, or
/// more than a hundred thousand pairs meet. On all processors; O(n log n) for ordinary meshes.
std::optional<std::vector<CrossingPair>> findSelfCrossings(const TriangleMesh& mesh, const MeshPieces& pieces,
                                                           const BoxPairs& boxes);

}  // namespace nearfit
