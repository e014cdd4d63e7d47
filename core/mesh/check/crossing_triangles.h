#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/progress.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Pairs of triangles of a mesh that meet elsewhere than where they are joined.
struct CrossingTriangles {
  std::vector<std::array<std::uint32_t, 2>> pairs;  ///< Indices, the lower one first; sorted.
  bool isComplete = true;                           ///< False if a limit ended the search: there may be more.
};

/// Finds where a mesh crosses or touches itself, within a component and between components: all pairs of triangles that
/// share more than their common corners and the side between these. Decided exactly. Pairs with the same three corners
/// do not count (they are duplicates), nor do triangles without area.
///
/// @param maxPairs  Stops after so many.
/// Stops too after the work of a hundred pairs of boxes a triangle and a hundred million more, some seconds. The result
/// is the same on every run. O(n log n) for ordinary meshes; one thread. Throws Cancelled.
CrossingTriangles findCrossingTriangles(const TriangleMesh& mesh, std::size_t maxPairs,
                                        const ProgressCallback& progress = {});

}  // namespace nearfit
