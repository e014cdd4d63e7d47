#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/path/assembly_path.h"
#include "core/path/path_clearance.h"
#include "core/servo/motion_recording.h"

namespace nearfit {

/// The path with poses added on the way between others, so that it can be played and measured evenly: all its
/// own poses stay, and so does the motion.
/// @param step      Max time between poses [s]; > 0. Longer if more than `maxAdded` poses would be added.
/// @param maxAdded  There are never more than kMaxPathPoses in all.
AssemblyPath sampledPath(const AssemblyPath& path, double step, std::size_t maxAdded);

/// Rows that play a path like a recording, one for each pose: times from 0, hand and part at the pose, no force. The
/// distance is not known: infinity.
std::vector<MotionRow> rowsOfPath(const AssemblyPath& path);

/// Puts the least clearance at each pose into rowsOfPath().
/// @param clearances  Of the same path; infinity beyond their range.
void setDistances(std::span<MotionRow> rows, const std::vector<PathClearance>& clearances);

}  // namespace nearfit
