#pragma once

#include "core/math/rigid_transform.h"
#include "core/proximity/motion_budget.h"

namespace nearfit {

/// Where to search ahead: the middle of a stretch of the way, and the range about it.
struct SearchPlan {
  RigidTransform pose;
  MotionRange range;
};

/// How a part has been moving of late, and so where to search for what its next ticks need.
///
/// What is found serves from when the search has ended until the next one has. The plan follows the way that
/// the part would go by itself in that time, and leaves room aside for as much as it has been off such a way
/// of late.
class MotionForecast {
 public:
  MotionForecast() = default;
  /// @param centre  Of the part, in its own frame [m].
  /// @param radius  Of a sphere about the centre that holds the part [m].
  MotionForecast(const glm::dvec3& centre, double radius) noexcept : centre_(centre), radius_(radius) {}

  /// Takes note of where the part is now.
  /// @param ticks  Since the last call; > 0.
  void observe(const RigidTransform& pose, double ticks) noexcept;
  const RigidTransform& pose() const noexcept { return pose_; }

  /// Until the next look at it, the part counts as one that is held up where it is and then goes on as its
  /// leader moves: how it moved itself tells how long it waited, not where it will go.
  /// @param leader  Of the hand that draws it; one that has seen nothing changes nothing.
  void goAs(const MotionForecast& leader) noexcept;

  /// How many ticks it takes from the start of a search until a tick has what it found; 0 when the tick
  /// waits for it. The longest of late counts.
  void setLead(double ticks) noexcept;

  /// Where the part will be in the first tick after a search that starts now; one that is held up a tick on.
  RigidTransform poseWhenReady() const noexcept;

  /// @param cutoff  Of the search [m]; room aside is bounded by it.
  /// @param share   Of the time that what is found is to serve; less makes less to find.
  SearchPlan plan(double cutoff, double share = 1.0) const noexcept;

 private:
  RigidTransform poseAhead(double ticks) const noexcept;
  void checkProbe(const RigidTransform& centred, double ticks) noexcept;

  glm::dvec3 centre_{0.0};
  double radius_ = 0.0;
  RigidTransform pose_;
  bool hasPose_ = false;
  bool isHeldUp_ = false;
  bool wasJump_ = false;
  /// Of the centre in a tick, and what it grows by from tick to tick.
  MotionStretch velocity_, trend_;
  MotionBudget fastest_;  ///< Of late, in a tick.
  /// A way that was foretold some ticks ago, to be compared with the one taken.
  struct Probe {
    RigidTransform from;  ///< Of the centre.
    MotionStretch velocity, trend;
    double age = 0.0;  ///< [ticks]
  };
  Probe probe_;
  MotionBudget error_;  ///< The farthest of late that the part was off its way, for a tick ahead.
  double lead_ = 0.0;
  double generosity_ = 1.0;  ///< Factor of the room aside.
};

}  // namespace nearfit
