#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/progress.h"
#include "core/scene/motion_recording.h"

namespace nearfit {

/// Longest recording that is read: more than an hour at 1 kHz, some gigabyte in memory.
constexpr std::size_t kMaxMotionRows = 4'000'000;

/// What a file holds of a recording.
struct ReadMotion {
  std::vector<MotionRow> rows;
  /// The file ends within a row, which is not among them: whatever wrote it was stopped.
  bool isCut = false;
};

/// Reads a recording (MotionWriter). Columns are told by their names in the first row, in any order;
/// unknown ones are passed over. Times, poses, force and torque must be there; a column that an older
/// recording lacks is as in a MotionRow that nobody has set, and the distance infinite.
///
/// Nothing that the file says is trusted. In what is returned, which is not empty: times begin with zero and
/// never fall, poses are as checkedPose has them, forces and torques are finite, distances at least zero
/// (infinity: nothing was within the cutoff), durations finite and at least zero.
/// Throws FileError with file, line, column and remedy; Cancelled.
ReadMotion readRecording(const std::filesystem::path& file, const ProgressCallback& progress = {});

/// The rows of readRecording.
std::vector<MotionRow> readMotion(const std::filesystem::path& file, const ProgressCallback& progress = {});

}  // namespace nearfit
