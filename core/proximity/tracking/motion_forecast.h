#pragma once

#include "core/math/rigid_transform.h"
#include "core/proximity/query/motion_budget.h"

namespace nearfit {

/// Plan of a search ahead: the middle of a stretch of the path, and the range about it.
struct SearchPlan {
  RigidTransform pose;
  MotionRange range;
};

/// Forecasts a part's motion from its recent motion, to plan searches for what its next ticks need.
///
/// A search's result serves from the end of that search to the end of the next. The plan follows the path
/// that the part would take by itself in that time, give or take the deviation seen recently. Real-time safe.
class MotionForecast {
 public:
  MotionForecast() = default;
  /// @param centre  Centre of the part in its own frame [m].
  /// @param radius  Radius of a sphere about the centre that holds the part [m].
  MotionForecast(const glm::dvec3& centre, double radius) noexcept : centre_(centre), radius_(radius) {}
  /// The same, for a part that goes in steps of several ticks: the path follows the mean motion of some of them.
  static MotionForecast steady(const glm::dvec3& centre, double radius) noexcept;

  /// Records the part's current pose; ignores one that is not finite.
  /// @param ticks  Ticks since the last call; > 0.
  void observe(const RigidTransform& pose, double ticks) noexcept;
  const RigidTransform& pose() const noexcept { return pose_; }  ///< Latest pose.

  /// From now on expects the part to move as its leader does, whatever it did itself.
  /// @param leader  Forecast of what leads it; ignored if it has observed nothing.
  void moveAs(const MotionForecast& leader) noexcept;
  /// Until the next observe(), treats the part as held up where it is, then moving as its leader does. Its
  /// own motion only shows how long it waited, not where it will go.
  /// @param leader  Forecast of the hand that leads it; ignored if it has observed nothing.
  void goAs(const MotionForecast& leader) noexcept;

  /// Reports the lead: ticks from the start of a search until a tick has its result; 0 if the tick waits for
  /// it. The longest recent lead counts.
  void setLead(double ticks) noexcept;
  /// The lead that counts [ticks]. Plans that do not say when they begin count less of a long one.
  double lead() const noexcept { return longestLead_; }

  /// Returns the pose expected in the first tick after a search that starts now; in the next if held up.
  RigidTransform poseWhenReady() const noexcept { return poseAfterwards(1.0); }
  /// The same so many ticks after the search has ended.
  RigidTransform poseAfterwards(double ticks) const noexcept;
  /// Returns the pose expected in so many ticks from now.
  RigidTransform poseIn(double ticks) const noexcept;

  /// Present motion of the part's farthest point [m per tick].
  double speed() const noexcept;

  /// Plans a search that starts now.
  /// @param cutoff  Cutoff of the search [m]; bounds the budget for deviation.
  /// @param share   Share of the time that the result should serve; a smaller share leaves less to find.
  SearchPlan plan(double cutoff, double share = 1.0) const noexcept;
  /// The same for a result that serves for so many ticks, whatever the search takes.
  /// @param begin  Ticks from now until then; 0 for a part that is held up, however long the search takes.
  SearchPlan planOfTicks(double cutoff, double begin, double ticks) const noexcept;

 private:
  SearchPlan planOver(double cutoff, double share, double begin, double ticks) const noexcept;
  void checkProbe(const RigidTransform& centred, double ticks) noexcept;

  glm::dvec3 centre_{0.0};
  double radius_ = 0.0;
  RigidTransform pose_;
  bool hasPose_ = false;
  bool isHeldUp_ = false;
  bool wasJump_ = false;
  /// Motion of the centre per tick, and its growth from tick to tick.
  MotionStretch velocity_, trend_;
  MotionBudget fastest_;  ///< Fastest recent motion, per tick.
  /// Path forecast some ticks ago, to compare with the one taken.
  struct Probe {
    RigidTransform from;  ///< Pose of the centre.
    MotionStretch velocity, trend;
    double age = 0.0;  ///< [ticks]
  };
  Probe probe_;
  MotionBudget error_;                     ///< Max recent deviation from the forecast path, one tick ahead.
  double lead_ = 0.0, longestLead_ = 0.0;  ///< At most kMaxLead, and at most kMaxLongLead [ticks].
  bool isSteady_ = false;
  double generosity_ = 1.0;  ///< Factor of the budget for deviation.
};

}  // namespace nearfit
