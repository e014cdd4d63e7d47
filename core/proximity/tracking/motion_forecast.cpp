#include "core/proximity/tracking/motion_forecast.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"

namespace nearfit {
namespace {

/// Share of the memory of the fastest motion, and of the slowest search, that remains after a tick: half is
/// gone after 35 ticks, in which a hand stops or reverses.
constexpr double kMemoryPerTick = 0.98;

/// Number of ticks for which a forecast path is followed, to see how far off it is.
constexpr double kProbeTicks = 6.0;
/// A part deviates from its path by a lasting change of velocity: with the square of the time.
constexpr double kErrorGrowth = 2.0;

/// Weights of the newest velocity, and of its newest change. They smooth the steps of encoders over some two
/// and some four ticks (Holt's double exponential smoothing, which unlike simple smoothing does not lag
/// behind a steady change).
constexpr double kVelocityShare = 0.5, kTrendShare = 0.25;
/// Weight of the newest velocity where a part goes in steps of several ticks. Its trend would follow the steps.
constexpr double kSteadyShare = 1.0 / 16.0;

/// How long a search's result must serve [ticks]: while the next search waits for its turn and runs, and a
/// little more; the shorter, the shorter the lists. If ticks wait for the search, long enough that few do.
double windowOf(double lead) noexcept {
  return lead > 0.0 ? lead + 1.5 : 6.0;
}

/// Max lead. A longer lead needs wider lists, which take longer to search: beyond this it would never end.
constexpr double kMaxLead = 3.0;
/// The same for plans whose length does not depend on it.
constexpr double kMaxLongLead = 32.0;

/// Factor by which the stretch is longer than the window, at both ends.
constexpr double kMargin = 1.2;
/// Max budget for deviation, as a share of the motion in half a window: being late now and then costs less
/// than lists that reach wherever a hand could turn.
constexpr double kMaxAside = 1.0;

/// Quick searches slowly widen the budget for deviation; slow ones soon narrow it.
constexpr double kShortLead = 0.9, kMoreRoom = 1.1, kLessRoom = 0.7, kMaxGenerosity = 4.0;

/// Even a hand at rest gets this share of the cutoff: it may start at any tick.
constexpr double kMinTravel = 0.02;
/// Beyond this share of the cutoff a list holds most of what is near, and a cold query does as well.
constexpr double kMaxTravel = 1.0;
/// Turning more makes nearly every feature a candidate [rad].
constexpr double kMinTurn = 1e-3, kMaxTurn = 0.1;

/// A step this many times the fastest recent one, and longer than a hand makes in a tick (a share of the
/// part's radius), means that the part was placed elsewhere. It is not taken for motion unless the next step
/// is like it.
constexpr double kJump = 3.0, kJumpOfRadius = 0.005;
/// The same share where a part goes in steps of several ticks.
constexpr double kJumpOfSteps = 0.04;

MotionBudget greater(const MotionBudget& a, const MotionBudget& b) noexcept {
  return {std::max(a.travel, b.travel), std::max(a.turn, b.turn)};
}

/// Updates a velocity and its trend with a velocity measured over some ticks.
void smooth(glm::dvec3& velocity, glm::dvec3& trend, const glm::dvec3& measured, double ticks,
            bool isSteady) noexcept {
  if (isSteady) {
    velocity += (1.0 - std::pow(1.0 - kSteadyShare, ticks)) * (measured - velocity);
    return;
  }
  const glm::dvec3 expected = velocity + ticks * trend;
  const glm::dvec3 next = expected + (1.0 - std::pow(1.0 - kVelocityShare, ticks)) * (measured - expected);
  trend += (1.0 - std::pow(1.0 - kTrendShare, ticks)) * ((next - velocity) / ticks - trend);
  velocity = next;
}

/// Returns the pose after some ticks of a velocity that grows by a trend. Frames are at the part's centre.
RigidTransform ahead(const RigidTransform& from, const MotionStretch& velocity, const MotionStretch& trend,
                     double ticks) noexcept {
  const double growth = 0.5 * ticks * (ticks + 1.0);
  return poseOn({ticks * velocity.shift + growth * trend.shift, ticks * velocity.spin + growth * trend.spin},
                from, 1.0);
}

/// Returns a vector, shortened to a limit if it is longer.
glm::dvec3 limited(const glm::dvec3& vector, double limit) noexcept {
  const double length = glm::length(vector);
  return length > limit ? (limit / length) * vector : vector;
}

}  // namespace

MotionForecast MotionForecast::steady(const glm::dvec3& centre, double radius) noexcept {
  MotionForecast out(centre, radius);
  out.isSteady_ = true;
  return out;
}

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
    longestLead_ *= memory;
    const bool isJump = motion.travel > std::max(kJump * fastest_.travel,
                                                 (isSteady_ ? kJumpOfSteps : kJumpOfRadius) * radius_);
    if (!isJump || wasJump_) {
      const MotionStretch now{(to.translation - from.translation) / ticks,
                              rotationVector(to.rotation * glm::conjugate(from.rotation)) / ticks};
      smooth(velocity_.shift, trend_.shift, now.shift, ticks, isSteady_);
      smooth(velocity_.spin, trend_.spin, now.spin, ticks, isSteady_);
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

void MotionForecast::moveAs(const MotionForecast& leader) noexcept {
  if (!leader.hasPose_) return;
  velocity_ = leader.velocity_;
  trend_ = leader.trend_;
}

void MotionForecast::goAs(const MotionForecast& leader) noexcept {
  if (!leader.hasPose_) return;
  moveAs(leader);
  isHeldUp_ = true;
}

void MotionForecast::checkProbe(const RigidTransform& centred, double ticks) noexcept {
  probe_.age += ticks;
  const RigidTransform foretold = ahead(probe_.from, probe_.velocity, probe_.trend, probe_.age);
  // Being early or late does not count: a stretch reaches farther than it must.
  const double time = nearestTime(probe_.velocity, foretold, centred, radius_);
  const MotionBudget off = motionBetween(poseOn(probe_.velocity, foretold, time), centred, radius_);
  error_ = greater(std::pow(probe_.age, -kErrorGrowth) * off, error_);
}

void MotionForecast::setLead(double ticks) noexcept {
  lead_ = std::max(lead_, std::min(ticks, kMaxLead));
  longestLead_ = std::max(longestLead_, std::min(ticks, kMaxLongLead));
  generosity_ = std::clamp(generosity_ * (ticks < kShortLead ? kMoreRoom : kLessRoom), 1.0, kMaxGenerosity);
}

RigidTransform MotionForecast::poseIn(double ticks) const noexcept {
  const RigidTransform centred{pose_.rotation, pose_.applyToPoint(centre_)};
  const RigidTransform to = ahead(centred, velocity_, trend_, ticks);
  return {to.rotation, to.translation - to.rotation * centre_};
}

RigidTransform MotionForecast::poseAfterwards(double ticks) const noexcept {
  return poseIn(isHeldUp_ ? ticks : lead_ + ticks);
}

double MotionForecast::speed() const noexcept {
  return glm::length(velocity_.shift) + radius_ * glm::length(velocity_.spin);
}

SearchPlan MotionForecast::plan(double cutoff, double share) const noexcept {
  // A held-up part begins where it is, however long the search takes.
  const double begin = isHeldUp_ ? 0.0 : lead_;
  return planOver(cutoff, share, begin, share * (lead_ + windowOf(lead_) - begin));
}

SearchPlan MotionForecast::planOfTicks(double cutoff, double begin, double ticks) const noexcept {
  return planOver(cutoff, 1.0, isHeldUp_ ? 0.0 : begin, ticks);
}

SearchPlan MotionForecast::planOver(double cutoff, double share, double begin, double whole) const noexcept {
  // Part of the travel comes from turning: the min travel must allow for the min turn.
  const double leastTravel = kMinTravel * cutoff + kMinTurn * radius_;
  const double mostTravel = std::max(leastTravel, kMaxTravel * cutoff);
  // A stretch that would be too long ends earlier, and begins as it would.
  const auto shareOf = [&](const glm::dvec3& velocity, const glm::dvec3& trend, double most) {
    const double length = 0.5 * kMargin * whole * glm::length(velocity + (begin + 0.5 * whole) * trend);
    return length > most ? most / length : 1.0;
  };
  const double window = whole * std::min(shareOf(velocity_.shift, trend_.shift, mostTravel),
                                         shareOf(velocity_.spin, trend_.spin, kMaxTurn));
  const double half = 0.5 * kMargin * window;
  const double growth = std::pow(begin + window, kErrorGrowth);
  const auto aside = [&](double fastest, double error) {
    return generosity_ * std::min(growth * error, kMaxAside * half * fastest);
  };
  const double middle = begin + 0.5 * window;
  SearchPlan plan{poseIn(middle), {}};
  plan.range.stretch = {limited(half * (velocity_.shift + middle * trend_.shift), mostTravel),
                        limited(half * (velocity_.spin + middle * trend_.spin), kMaxTurn)};
  plan.range.budget = {share * std::clamp(aside(fastest_.travel, error_.travel), leastTravel, mostTravel),
                       share * std::clamp(aside(fastest_.turn, error_.turn), kMinTurn, kMaxTurn)};
  return plan;
}

}  // namespace nearfit
