#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/servo/motion_recording.h"

namespace nearfit::desktop {

/// Writes what the servo does to a file, as `nearfit-cli place --record` does. If the servo restarts
/// meanwhile, the recording's time goes on.
class MotionRecorder {
 public:
  /// Throws FileError.
  explicit MotionRecorder(const std::filesystem::path& file) : writer_(file) {}

  /// Appends rows, in the order of the ticks. Throws FileError.
  void write(const std::vector<MotionRow>& rows) {
    for (MotionRow row : rows) {
      if (count_ > 0 && row.time + offset_ < last_) offset_ = last_ + kTick - row.time;
      row.time += offset_;
      if (count_ == 0) first_ = row.time;
      last_ = row.time;
      ++count_;
      writer_.write(row);
    }
  }
  /// Completes the file. Throws FileError.
  void finish() { writer_.finish(); }
  /// After a failure: keeps what was written before it, as MotionWriter does, and returns
  /// how long that is [s].
  std::optional<double> keepWritten() {
    const std::optional<double> last = writer_.keepWritten();
    return last ? std::optional(*last - first_) : std::nullopt;
  }

  std::size_t rowCount() const noexcept { return count_; }
  /// Returns the time that the recording covers so far [s].
  double seconds() const noexcept { return last_ - first_; }

 private:
  static constexpr double kTick = 1e-3;  ///< [s]

  MotionWriter writer_;
  std::size_t count_ = 0;
  double offset_ = 0.0, first_ = 0.0, last_ = 0.0;  ///< [s]
};

}  // namespace nearfit::desktop
