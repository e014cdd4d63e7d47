#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/math/rigid_transform.h"

namespace nearfit::bench {

/// A pose of a recording and the line that has it, the header being line 1.
struct RecordedPose {
  RigidTransform pose;
  std::size_t line = 0;
  /// The part overlapped something that was not felt: column `released`; never where there is no such column.
  bool isReleased = false;
};

/// The poses NAME_tx ... NAME_qz of a CSV file with a header, as `nearfit-cli place --record` writes them:
/// whatever other columns there are.
/// @param every  Only each so many-th row, from the first on; >= 1.
/// Throws FileError naming the line.
std::vector<RecordedPose> readRecordedPoses(const std::filesystem::path& file, const std::string& name,
                                            std::size_t every);

}  // namespace nearfit::bench
