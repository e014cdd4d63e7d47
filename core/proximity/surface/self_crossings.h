#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/math/triangle_corners.h"
#include "core/proximity/overlap/containment.h"
#include "core/proximity/query/box_pairs.h"

namespace nearfit {

/// Indices of two triangles of a component.
using CrossingPair = std::array<std::uint32_t, 2>;

/// Corners of a triangle in the mesh's frame [m].
TriangleCorners cornersOf(const TriangleMesh& mesh, std::uint32_t triangle);

/// Returns the boxes of all triangles, ready for searches.
BoxPairs boxesOfTriangles(const TriangleMesh& mesh);

/// Finds where components cross or touch themselves: all pairs of triangles of one component that share more
/// than their common corners, the lower index first, sorted. Decided exactly. Meetings of different
/// components do not count.
///
/// @param boxes  From boxesOfTriangles().
/// No value if too many boxes of triangles overlap (more than a hundred per triangle plus a hundred million),
/// or more than a hundred thousand pairs meet. Runs on all processors; O(n log n) for ordinary meshes.
std::optional<std::vector<CrossingPair>> findSelfCrossings(const TriangleMesh& mesh,
                                                           const MeshComponents& pieces,
                                                           const BoxPairs& boxes);

}  // namespace nearfit
