#pragma once

#include <cstddef>
#include <vector>

#include "core/haptics/servo_snapshot.h"
#include "core/scene/motion_recording.h"

namespace nearfit {

/// A recording that is played: which of its rows counts at which time. What shows it tells it how time
/// passes.
class MotionPlayback {
 public:
  /// Slowest and fastest, as a multiple of the speed at which it was recorded.
  static constexpr double kMinSpeed = 0.01, kMaxSpeed = 100.0;

  /// @param rows  Not empty; times begin with zero and never fall (readMotion).
  explicit MotionPlayback(std::vector<MotionRow> rows);

  const std::vector<MotionRow>& rows() const noexcept { return rows_; }
  /// Of the last row [s].
  double duration() const noexcept { return rows_.back().time; }
  /// Where it stands, from 0 to duration() [s].
  double time() const noexcept { return time_; }
  /// The last row that is no later than time().
  std::size_t index() const noexcept { return index_; }
  const MotionRow& row() const noexcept { return rows_[index_]; }

  /// To a time, within the recording; not a number is its beginning. O(log n).
  void seek(double time) noexcept;
  /// To the row so many rows after (before, where negative) the one that counts.
  void step(std::ptrdiff_t rows) noexcept;
  /// Goes on by `seconds` of the viewer's time. Past the end it begins again where it loops, else it stays
  /// there. False once it stands at the end.
  bool advance(double seconds) noexcept;

  /// Clamped to the limits; a number that is none changes nothing.
  void setSpeed(double speed) noexcept;
  double speed() const noexcept { return speed_; }
  void setLooping(bool isLooping) noexcept { isLooping_ = isLooping; }
  bool isLooping() const noexcept { return isLooping_; }

 private:
  std::vector<MotionRow> rows_;
  double time_ = 0.0, speed_ = 1.0;
  std::size_t index_ = 0;
  bool isLooping_ = false;
};

/// What a row tells, as a snapshot of the tick; its minima and contacts are counted there, and none are
/// stored.
/// @param moving  The part that was in hand.   @param out  Overwritten.
void takeRow(const MotionRow& row, const Part& moving, ServoSnapshot& out);

}  // namespace nearfit
