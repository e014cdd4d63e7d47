#pragma once

#include <cstdint>

#include "core/haptics/step_program.h"

namespace nearfit {

/// A step of the program, and its cost given the true distance at its end.
class StepTrial {
 public:
  /// @param distance  Lower bound on the distance to the nearest body where the step begins [m].
  StepTrial(const StepGoal& goal, const StepSolution& solution, double distance) noexcept;

  /// True if the step lowers the program's cost. If not, bestShare() estimates where on the way the
  /// cost is lowest.
  /// @param distance  Of the nearest body where the step ends [m].
  bool isGain(double distance) noexcept;
  /// Share of the step with the lowest cost, from the parabola of the last isGain(); at most kHalf then.
  double bestShare() const noexcept { return bestShare_; }

  /// Scales the step.
  void shorten(double share) noexcept;

 private:
  StepVector wanted_, step_;
  ClearanceCost cost_;
  double distance_;
  double slope_;  ///< Slope of the cost along the step, at its start.
  double bestShare_ = 1.0;
};

/// Decides whether a planned step may be taken.
class StepJudge {
 public:
  /// A step may reduce the clearance, or the margin if that is less, to this share.
  static constexpr double kHalf = 0.5;
  /// One that is longer than the distance where it begins keeps this share: what it comes upon is not planned
  /// for, and shorter steps are.
  static constexpr double kLongKeeps = 0.9;

  /// The decision on a step.
  enum class Verdict : std::uint8_t {
    Taken,      ///< It may be taken.
    NotProved,  ///< Something might be met on the way, or is too near at its end.
    NoGain,     ///< No better than staying.
    Unknown,    ///< The work allowed was too little to tell.
  };

  /// A way from one pose to another. Distances are lower bounds, to bodies that are not overlapped [m].
  struct Way {
    double travel = 0.0;             ///< No point of the part moves farther than this [m].
    double here = 0.0, there = 0.0;  ///< At its start and at its end.
    double margin = 0.0;
    double deviation = 0.0;  ///< The bodies may be nearer than these distances by this much [m].
    double onWay = 0.0;      ///< The distance anywhere on the way, as far as that is known [m].
  };
  /// Decides on a way; never Unknown. Real-time safe.
  /// @param trial  Null if the step need not be a gain.
  Verdict judge(const Way& way, StepTrial* trial) const noexcept;

  /// From now on no step may end nearer to a body than a share of the distance here.
  /// @param distance  At the present pose [m].
  /// @param lengths   Lengths whose rounding limits the distance [m].
  void raiseFloor(double distance, double margin, double lengths) noexcept;
  /// Allows any distance again.
  void dropFloor() noexcept { floor_ = 0.0; }

 private:
  double floor_ = 0.0;  ///< Min distance at a step's end, unless the step leads away [m].
};

}  // namespace nearfit
