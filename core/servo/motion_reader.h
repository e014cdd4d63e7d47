#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/base/progress.h"
#include "core/servo/motion_recording.h"

namespace nearfit {

/// Max rows read: more than an hour at 1 kHz, about a gigabyte in memory.
constexpr std::size_t kMaxMotionRows = 4'000'000;

/// The content of a recording file.
struct Recording {
  std::vector<MotionRow> rows;
  /// True if the file ends in the middle of a row, which is dropped: writing was interrupted.
  bool isCut = false;
};

/// Reads a recording written by MotionWriter. Columns are identified by the header and may come in any order;
/// unknown ones are skipped. Time, poses, force and torque are required. Other missing columns take
/// MotionRow's defaults, except the distance, which becomes infinite.
///
/// All values are checked. The result is not empty; times start at 0 and never decrease; poses are valid
/// (checkedPose), forces and torques finite, distances >= 0 (infinity: nothing within the cutoff), durations
/// finite and >= 0.
/// Throws FileError with file, line, column and remedy; Cancelled.
Recording readRecording(const std::filesystem::path& file, const ProgressCallback& progress = {});

/// Returns the rows of readRecording().
std::vector<MotionRow> readMotion(const std::filesystem::path& file, const ProgressCallback& progress = {});

}  // namespace nearfit
