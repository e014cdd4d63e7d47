#pragma once

#include <cstddef>
#include <vector>

#include "core/servo/motion_recording.h"
#include "core/servo/servo_snapshot.h"

namespace nearfit {

/// Plays a recording: tracks the playback time and the row it selects. The caller advances the time.
class MotionPlayback {
 public:
  /// Limits of the playback speed, as a multiple of the recorded speed.
  static constexpr double kMinSpeed = 0.01, kMaxSpeed = 100.0;

  /// @param rows  Not empty; times start at 0 and never decrease (readMotion).
  explicit MotionPlayback(std::vector<MotionRow> rows);

  const std::vector<MotionRow>& rows() const noexcept { return rows_; }
  /// Time of the last row [s].
  double duration() const noexcept { return rows_.back().time; }
  /// Playback time, 0 to duration() [s].
  double time() const noexcept { return time_; }
  /// Index of the last row that is no later than time().
  std::size_t index() const noexcept { return index_; }
  /// The row at index().
  const MotionRow& row() const noexcept { return rows_[index_]; }

  /// Goes to a time [s], clamped to the recording; NaN goes to the start. O(log n).
  void seek(double time) noexcept;
  /// Moves by a number of rows, backward if negative; clamped to the recording.
  void step(std::ptrdiff_t rows) noexcept;
  /// Advances by `seconds` of viewing time, scaled by the speed. At the end it wraps if looping, else stops
  /// there. Returns false once it has stopped at the end.
  bool advance(double seconds) noexcept;

  /// Sets the speed, clamped to the limits; NaN and infinity are ignored.
  void setSpeed(double speed) noexcept;
  double speed() const noexcept { return speed_; }
  /// If true, playback restarts at the end.
  void setLooping(bool isLooping) noexcept { isLooping_ = isLooping; }
  bool isLooping() const noexcept { return isLooping_; }

 private:
  std::vector<MotionRow> rows_;
  double time_ = 0.0, speed_ = 1.0;
  std::size_t index_ = 0;
  bool isLooping_ = false;
};

/// Fills a snapshot from a row. Minima and contacts are counted, not stored.
/// @param moving  The part that was moving.
/// @param out     Overwritten.
void takeRow(const MotionRow& row, const Part& moving, ServoSnapshot& out);

}  // namespace nearfit
