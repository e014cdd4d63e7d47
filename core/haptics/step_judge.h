#pragma once

#include <cstdint>

#include "core/haptics/step_program.h"

namespace nearfit {

/// A step as the program has it, and what it costs by the true distance at its end.
class StepTrial {
 public:
  /// @param distance  Of the nearest body where the step begins [m].
  StepTrial(const StepGoal& goal, const StepSolution& solution, double distance) noexcept;

  /// Whether it makes less what the program makes least. If not, bestShare() says where that is less.
  /// @param distance  Of the nearest body where the step ends [m].
  bool isGain(double distance) noexcept;
  /// Share of the step at which the cost is least, as a parabola has it that the last isGain() knew.
  double bestShare() const noexcept { return bestShare_; }

  void shorten(double share) noexcept;

 private:
  StepVector wanted_, step_;
  ClearanceCost cost_;
  double distance_;
  double slope_;  ///< Of the cost along the step, at its start.
  double bestShare_ = 1.0;
};

/// Says of a step that is planned whether it may be taken.
class StepJudge {
 public:
  /// A step may bring what it is to keep down to this share of what it has.
  static constexpr double kHalf = 0.5;

  enum class Verdict : std::uint8_t {
    Taken,
    NotProved,  ///< Something might be met on the way, or is too near there.
    NoGain,     ///< No better than where it is.
    Unknown,    ///< The work allowed did not suffice to tell.
  };

  /// A way from a pose to another; distances are bounds below, of bodies that are not overlapped [m].
  struct Way {
    double travel = 0.0;  ///< No point of the part moves farther [m].
    double here = 0.0, there = 0.0;
    double margin = 0.0;
  };
  /// @param trial  Null where the step need not be a gain.
  /// Never Unknown. Real-time safe.
  Verdict judge(const Way& way, StepTrial* trial) const noexcept;

  /// No step may end nearer to a body than a share of the distance here, from now on.
  /// @param distance  Here.   @param lengths  That it is rounded with [m].
  void raiseFloor(double distance, double margin, double lengths) noexcept;
  void dropFloor() noexcept { floor_ = 0.0; }

 private:
  double floor_ = 0.0;  ///< No step may end nearer than this to a body, unless it leads away [m].
};

}  // namespace nearfit
