#pragma once

#include <vector>

#include "core/base/progress.h"
#include "core/math/triangle_corners.h"
#include "core/mesh/mesh_builder.h"

namespace nearfit {

/// Places of faces that buildMesh() leaves out [m]: at most MeshFinding::kMaxShown of each kind.
struct SoupFaults {
  std::vector<TriangleCorners> degenerate, duplicate;
};

/// Finds faces of a file that have no area, or repeat another in the same sense. A polygon is given by three of its
/// corners. Lists of corners that refer to no vertex are left out. O(n log n). Throws Cancelled.
SoupFaults findSoupFaults(const PolygonSoup& soup, const MeshBuildOptions& options,
                          const ProgressCallback& progress = {});

}  // namespace nearfit
