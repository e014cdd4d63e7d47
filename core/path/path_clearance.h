#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/path/assembly_path.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Clearance of what moves on a path to one other part, pose by pose.
struct PathClearance {
  PartId other{};
  /// By pose: least distance of the surfaces [m], 0 where they meet; infinity beyond the range.
  std::vector<double> distances;
};

/// Least clearance along a path, at its poses.
struct LeastPathClearance {
  double distance = 0.0;  ///< [m]
  double time = 0.0;      ///< [s]
  PartId other{};
};

/// Clearances along a path to each part that comes within a range, in scene order. Distances are those of the searched
/// meshes. On all processors. Builds missing hierarchies. Throws UsageError if the range is not valid, or as checkPath()
/// and pathBodies(); Cancelled.
/// @param range  [m]; finite, > 0.
std::vector<PathClearance> clearancesAlong(const Scene& scene, const AssemblyPath& path, double range,
                                           const ProgressCallback& progress = {});

/// The least of all; std::nullopt if nothing is within the range.
std::optional<LeastPathClearance> leastOf(const std::vector<PathClearance>& clearances,
                                          const AssemblyPath& path);

/// The clearances as CSV (UTF-8), one row a pose: `t_s`, then a column `NAME [m]` for each part; `inf` beyond the range.
std::string pathClearanceCsv(const Scene& scene, const AssemblyPath& path,
                             const std::vector<PathClearance>& clearances);

}  // namespace nearfit
