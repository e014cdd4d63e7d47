#pragma once

#include <cstddef>

#include "core/base/progress.h"
#include "core/path/assembly_path.h"
#include "core/path/path_certifier.h"

namespace nearfit {

/// A path with fewer or smoother poses, and what that took.
struct ChangedPath {
  AssemblyPath path;
  std::size_t changed = 0;  ///< Poses left out, or moved.
  /// Changes that were not proven free, so that the original stayed there.
  std::size_t refused = 0;
};

/// Leaves out poses as long as no point of the body is farther than `tolerance` from where the path has it at the time
/// of a pose, and each segment that spans poses left out is proven free. Where it is not, poses come back, down to the
/// original ones. Source: Douglas and Peucker 1973, with the time as parameter.
/// @param certifier  Of the same parts and centre.
/// @param tolerance  [m]; > 0. Throws UsageError if it is not valid; Cancelled.
/// Segments between two poses that follow each other in the original are kept as they are, proven or not.
ChangedPath thinned(const AssemblyPath& path, const PathCertifier& certifier, double tolerance,
                    const ProgressCallback& progress = {});

/// Moves poses, again and again, half the way to the middle between their neighbours in time, as long as no point of the
/// body is farther than `tolerance` from where it was, and both segments at the pose are proven free; a pose for which
/// they are not stays where it was. The first and the last pose stay, and so do all times.
/// @param certifier  Of the same parts and centre.
/// @param tolerance  [m]; > 0. Throws UsageError if it is not valid; Cancelled.
ChangedPath smoothed(const AssemblyPath& path, const PathCertifier& certifier, double tolerance,
                     const ProgressCallback& progress = {});

}  // namespace nearfit
