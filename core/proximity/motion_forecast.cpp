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
/// A part gets off its way by a change of its velocity that goes on: the square of the time.
constexpr double kErrorGrowth = 2.0;

/// How much of the newest velocity counts, and of the newest change of it: smooths the steps of encoders over
/// some two and some four ticks (Holt's double exponential smoothing, which does not lag behind a steady
/// change as simple smoothing does).
constexpr double kVelocityShare = 0.5, kTrendShare = 0.25;

/// How long what is found must serve, in ticks: while the next search waits for its turn and runs, and a
/// little more; the shorter, the shorter the lists. Where ticks wait for the search, long enough that they
/// seldom do.
double windowOf(double lead) noexcept {
  return lead > 0.0 ? lead + 1.5 : 6.0;
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

/// Brings a velocity and its trend up to date with one that was measured over some ticks.
void smooth(glm::dvec3& velocity, glm::dvec3& trend, const glm::dvec3& measured, double ticks) noexcept {
  const glm::dvec3 expected = velocity + ticks * trend;
  const glm::dvec3 next = expected + (1.0 - std::pow(1.0 - kVelocityShare, ticks)) * (measured - expected);
  trend += (1.0 - std::pow(1.0 - kTrendShare, ticks)) * ((next - velocity) / ticks - trend);
  velocity = next;
}

/// Where a velocity that grows by a trend leads in some ticks; frames have their origin in the part's centre.
RigidTransform ahead(const RigidTransform& from, const MotionStretch& velocity, const MotionStretch& trend,
                     double ticks) noexcept {
  const double growth = 0.5 * ticks * (ticks + 1.0);
  return poseOn({ticks * velocity.shift + growth * trend.shift, ticks * velocity.spin + growth * trend.spin},
                from, 1.0);
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
  const RigidTransform to{next.rotation, next.applyToPoint(centre_)};
  if (!hasPose_) {
    probe_.from = to;
  } else {
    const RigidTransform from{pose_.rotation, pose_.applyToPoint(centre_)};
    const MotionBudget motion = (1.0 / ticks) * motionBetween(from, to, radius_);
    const double memory = std::pow(kMemoryPerTick, ticks);
    fastest_ = memory * fastest_;
    error_ = memory * error_;
    lead_ *= memory;
    const bool isJump = motion.travel > std::max(kJump * fastest_.travel, kJumpOfRadius * radius_);
    if (!isJump || wasJump_) {
      const MotionStretch now{(to.translation - from.translation) / ticks,
                              rotationVector(to.rotation * glm::conjugate(from.rotation)) / ticks};
      smooth(velocity_.shift, trend_.shift, now.shift, ticks);
      smooth(velocity_.spin, trend_.spin, now.spin, ticks);
      fastest_ = greater(motion, fastest_);
      checkProbe(to, ticks);
    }
    if (isJump || probe_.age >= kProbeTicks) probe_ = {to, velocity_, trend_, 0.0};
    wasJump_ = isJump;
  }
  pose_ = next;
  hasPose_ = true;
  isHeldUp_ = false;
}

void MotionForecast::goAs(const MotionForecast& leader) noexcept {
  if (!leader.hasPose_) return;
  velocity_ = leader.velocity_;
  trend_ = leader.trend_;
  isHeldUp_ = true;
}

void MotionForecast::checkProbe(const RigidTransform& centred, double ticks) noexcept {
  probe_.age += ticks;
  const RigidTransform foretold = ahead(probe_.from, probe_.velocity, probe_.trend, probe_.age);
  // What it is early or late by does not count: a stretch reaches farther than it must.
  const double time = nearestTime(probe_.velocity, foretold, centred, radius_);
  const MotionBudget off = motionBetween(poseOn(probe_.velocity, foretold, time), centred, radius_);
  error_ = greater(std::pow(probe_.age, -kErrorGrowth) * off, error_);
}

void MotionForecast::setLead(double ticks) noexcept {
  lead_ = std::max(lead_, std::min(ticks, kMostLead));
  generosity_ = std::clamp(generosity_ * (ticks < kShortLead ? kMoreRoom : kLessRoom), 1.0, kMostGenerosity);
}

RigidTransform MotionForecast::poseAhead(double ticks) const noexcept {
  const RigidTransform centred{pose_.rotation, pose_.applyToPoint(centre_)};
  const RigidTransform to = ahead(centred, velocity_, trend_, ticks);
  return {to.rotation, to.translation - to.rotation * centre_};
}

RigidTransform MotionForecast::poseWhenReady() const noexcept {
  return poseAhead(isHeldUp_ ? 1.0 : lead_ + 1.0);
}

SearchPlan MotionForecast::plan(double cutoff, double share) const noexcept {
  // What is held up begins where it is, however long the search takes.
  const double begin = isHeldUp_ ? 0.0 : lead_;
  const double window = share * (lead_ + windowOf(lead_) - begin), half = 0.5 * kMargin * window;
  const double growth = std::pow(begin + window, kErrorGrowth);
  const auto aside = [&](double fastest, double error) {
    return generosity_ * std::min(growth * error, kMostAside * half * fastest);
  };
  // Part of the travel comes from turning: the least turn must not be out of reach of the least travel.
  const double leastTravel = kLeastTravel * cutoff + kLeastTurn * radius_;
  const double mostTravel = std::max(leastTravel, kMostTravel * cutoff);
  const double middle = begin + 0.5 * window;
  SearchPlan plan{poseAhead(middle), {}};
  plan.range.stretch = {limited(half * (velocity_.shift + middle * trend_.shift), mostTravel),
                        limited(half * (velocity_.spin + middle * trend_.spin), kMostTurn)};
  plan.range.budget = {share * std::clamp(aside(fastest_.travel, error_.travel), leastTravel, mostTravel),
                       share * std::clamp(aside(fastest_.turn, error_.turn), kLeastTurn, kMostTurn)};
  return plan;
}

}  // namespace nearfit
