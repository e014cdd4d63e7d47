#include "core/proximity/motion_forecast.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"

namespace nearfit {
namespace {

/// Share of the memory of the fastest motion, and of the slowest search, that a tick leaves: half is gone
/// after 35 ticks, in which a hand stops or turns round.
constexpr double kMemoryPerTick = 0.98;

/// A way foretold is followed for so many ticks, to see how far off it was.
constexpr double kProbeTicks = 6.0;
/// A part gets off its way by a growing velocity, which adds up over time: between steadily (2) and at random
/// (1.5).
constexpr double kErrorGrowth = 1.5;

/// How much of the newest velocity counts: smooths the steps of encoders over some three ticks.
constexpr double kVelocityShare = 0.4;

/// How long what is found must serve, in ticks: while the next search waits for its turn and runs, and one
/// more. The shorter, the shorter the lists.
double windowOf(double lead) noexcept {
  return lead > 0.0 ? 2.0 * lead + 1.0 : 6.0;
}

/// A longer lead asks for wider lists, and those take longer to search: beyond this it would never end.
constexpr double kMostLead = 3.0;

/// The stretch is this much longer than the window, at both ends.
constexpr double kMargin = 1.2;
/// Room aside at most, as a share of the motion in half a window: being late now and then costs less than
/// lists that reach wherever a hand could turn.
constexpr double kMostAside = 1.0;

/// While searches are quick, they look for more and more; when they are not, they soon look for less.
constexpr double kShortLead = 0.9, kMoreRoom = 1.1, kLessRoom = 0.7, kMostGenerosity = 4.0;

/// Even a hand at rest gets this share of the cutoff: it may start at any tick.
constexpr double kLeastTravel = 0.02;
/// Beyond this share of the cutoff a list holds most of what is near, and a cold query does as well.
constexpr double kMostTravel = 1.0;
/// Turning further makes nearly every feature a candidate [rad].
constexpr double kLeastTurn = 1e-3, kMostTurn = 0.1;

/// A step this many times the fastest of late, and more than a hand does in a tick, is no motion to go on
/// with unless the next one is like it: the part was put elsewhere. The second is a share of its radius.
constexpr double kJump = 3.0, kJumpOfRadius = 0.005;

MotionBudget greater(const MotionBudget& a, const MotionBudget& b) noexcept {
  return {std::max(a.travel, b.travel), std::max(a.turn, b.turn)};
}

/// A vector, shortened where it is longer than a limit.
glm::dvec3 limited(const glm::dvec3& vector, double limit) noexcept {
  const double length = glm::length(vector);
  return length > limit ? (limit / length) * vector : vector;
}

}  // namespace

void MotionForecast::observe(const RigidTransform& pose, double ticks) noexcept {
  if (!pose.isFinite()) return;
  const RigidTransform next = pose.normalized();
  if (hasPose_) {
    const RigidTransform from{pose_.rotation, pose_.applyToPoint(centre_)};
    const RigidTransform to{next.rotation, next.applyToPoint(centre_)};
    const MotionBudget motion = (1.0 / ticks) * motionBetween(from, to, radius_);
    const double memory = std::pow(kMemoryPerTick, ticks);
    fastest_ = memory * fastest_;
    error_ = memory * error_;
    lead_ *= memory;
    const bool isJump = motion.travel > std::max(kJump * fastest_.travel, kJumpOfRadius * radius_);
    if (!isJump || wasJump_) {
      const double share = 1.0 - std::pow(1.0 - kVelocityShare, ticks);
      step_ += share * ((to.translation - from.translation) / ticks - step_);
      turn_ += share * (rotationVector(to.rotation * glm::conjugate(from.rotation)) / ticks - turn_);
      fastest_ = greater(motion, fastest_);
      checkProbe(to, ticks);
    }
    if (isJump || probe_.age >= kProbeTicks) probe_ = {to, {step_, turn_}, 0.0};
    wasJump_ = isJump;
  }
  pose_ = next;
  hasPose_ = true;
}

void MotionForecast::checkProbe(const RigidTransform& centred, double ticks) noexcept {
  probe_.age += ticks;
  const MotionStretch way{probe_.age * probe_.perTick.shift, probe_.age * probe_.perTick.spin};
  const double time = nearestTime(way, probe_.from, centred, radius_);
  const MotionBudget off = motionBetween(poseOn(way, probe_.from, time), centred, radius_);
  error_ = greater(std::pow(probe_.age, -kErrorGrowth) * off, error_);
}

void MotionForecast::setLead(double ticks) noexcept {
  lead_ = std::max(lead_, std::min(ticks, kMostLead));
  generosity_ = std::clamp(generosity_ * (ticks < kShortLead ? kMoreRoom : kLessRoom), 1.0, kMostGenerosity);
}

RigidTransform MotionForecast::poseAhead(double ticks) const noexcept {
  const glm::dquat rotation = glm::normalize(rotationOf(ticks * turn_) * pose_.rotation);
  return {rotation, pose_.applyToPoint(centre_) + ticks * step_ - rotation * centre_};
}

RigidTransform MotionForecast::poseWhenReady() const noexcept {
  return poseAhead(lead_ + 1.0);
}

SearchPlan MotionForecast::plan(double cutoff, double share) const noexcept {
  const double window = share * windowOf(lead_), half = 0.5 * kMargin * window;
  const double ahead = std::pow(lead_ + window, kErrorGrowth);
  const auto aside = [&](double fastest, double error) {
    return generosity_ * std::min(ahead * error, kMostAside * half * fastest);
  };
  // Part of the travel comes from turning: the least turn must not be out of reach of the least travel.
  const double leastTravel = kLeastTravel * cutoff + kLeastTurn * radius_;
  const double mostTravel = std::max(leastTravel, kMostTravel * cutoff);
  SearchPlan plan{poseAhead(lead_ + 0.5 * window), {}};
  plan.range.stretch = {limited(half * step_, mostTravel), limited(half * turn_, kMostTurn)};
  plan.range.budget = {share * std::clamp(aside(fastest_.travel, error_.travel), leastTravel, mostTravel),
                       share * std::clamp(aside(fastest_.turn, error_.turn), kLeastTurn, kMostTurn)};
  return plan;
}

}  // namespace nearfit
