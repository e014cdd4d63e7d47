#include "tests/stress/tick_checks.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/haptics/virtual_coupling.h"
#include "core/servo/servo_faults.h"
#include "core/servo/work_bound.h"

namespace nearfit::stress {
namespace {

/// Rounding of a wrench that is scaled down to its limit.
constexpr double kLimitSlack = 1e-9;

double offUnit(const glm::dquat& q) {
  return std::abs(std::sqrt(glm::dot(q, q)) - 1.0);
}

bool isFinite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isFinite(const Wrench& w) {
  return isFinite(w.force) && isFinite(w.torque);
}

bool areNumbers(const ServoSnapshot& s) {
  return s.proxy.isFinite() && s.handle.isFinite() && isFinite(s.wrench) && isFinite(s.deviceWrench) &&
         isFinite(s.unclampedWrench) && isFinite(s.centre) && !std::isnan(s.distance) && s.distance >= 0.0 &&
         std::isfinite(s.energyToHand) && std::isfinite(s.period);
}

std::optional<std::string> contactFault(const ServoSnapshot& s) {
  for (std::size_t i = 0; i < s.storedContacts; ++i) {
    const SnapshotContact& c = s.contacts[i];
    if (!isFinite(c.point) || !isFinite(c.direction) || !std::isfinite(c.force) || c.force < 0.0)
      return fmt::format("contact {} is none", i);
  }
  return {};
}

}  // namespace

void EnergyLedger::add(const ServoScene& scene, const ServoParameters& parameters,
                       const ServoSnapshot& before, const ServoSnapshot& now, double period) {
  const glm::dvec3& centre = scene.centreInPart;
  const glm::dvec3 shift = now.handle.applyToPoint(centre) - before.handle.applyToPoint(centre);
  const glm::dvec3 turn = turnBetween(before.handle.rotation, now.handle.rotation);
  const double given = glm::dot(before.wrench.force, shift) + glm::dot(before.wrench.torque, turn);
  given_ += given;
  const DeviceLimits& limits = parameters.limits;
  const double damped =
      (limits.damping * glm::dot(shift, shift) + limits.rotationalDamping * glm::dot(turn, turn)) / period;
  // The part moved in the tick before, under its weight.
  const FeltMass felt = feltBody(parameters.haptics.weight, scene.mass, limits.maxForce);
  const double fallen = glm::dot(felt.weight, now.centre - before.centre);
  gain_ += given - damped - fallen;
  const Twist twist{(now.centre - before.centre) / period,
                    turnBetween(before.proxy.rotation, now.proxy.rotation) / period};
  const double stored = storedEnergy(now.coupling, scene.metric, centre, now.handle, now.proxy, limits) +
                        kineticEnergy(felt, scene.metric, {now.proxy, twist});
  if (!hasLeast_ || gain_ + stored < least_) least_ = gain_ + stored;
  hasLeast_ = true;
  largestGain_ = std::max(largestGain_, gain_ - least_);
}

void TickExtremes::add(const ServoSnapshot& s) {
  quaternionError = std::max({quaternionError, offUnit(s.proxy.rotation), offUnit(s.handle.rotation)});
  work = std::max(work, s.work);
  force = std::max(force, glm::length(s.wrench.force));
  torque = std::max(torque, glm::length(s.wrench.torque));
  starved += s.isStarved ? 1 : 0;
  waiting += s.isWaiting ? 1 : 0;
  shortened += s.shortenedSteps;
  refused += s.refusedSteps;
  inContact += s.contactCount > 0 || (s.mode == HapticMode::Springs && s.areaCount > 0) ? 1 : 0;
  heldTicks += s.springShares.isHeld() ? 1 : 0;
}

void TickExtremes::addStep(const ServoScene& scene, const ServoSnapshot& before, const ServoSnapshot& now) {
  forceStep = std::max(forceStep, glm::distance(before.unclampedWrench.force, now.unclampedWrench.force));
  const glm::dvec3& centre = scene.centreInPart;
  lag = std::max(lag, glm::distance(now.proxy.applyToPoint(centre), now.handle.applyToPoint(centre)));
}

std::optional<std::string> faultOf(const ServoSnapshot& now, const ServoSnapshot& before,
                                   const ServoParameters& parameters, double period) {
  if (now.fault != ServoFault::None) return fmt::format("fault: {}", faultReason(now.fault));
  if (!areNumbers(now)) return "a number is none";
  if (offUnit(now.proxy.rotation) > kQuaternionError || offUnit(now.handle.rotation) > kQuaternionError)
    return fmt::format("quaternion off by {:.3g}", offUnit(now.proxy.rotation));
  const bool isProxy = now.mode == HapticMode::Proxy;
  if (isProxy && now.overlappingCount > 0) return "the part is said to overlap a body";
  if (!isProxy && now.proxy.translation != now.handle.translation) return "the part is not where the hand is";
  const DeviceLimits& limits = parameters.limits;
  if (glm::length(now.wrench.force) > limits.maxForce * (1.0 + kLimitSlack) ||
      glm::length(now.wrench.torque) > limits.maxTorque * (1.0 + kLimitSlack))
    return "the wrench is beyond the device's limits";
  if (glm::distance(now.wrench.force, before.wrench.force) > limits.forceSlew * period * (1.0 + kLimitSlack))
    return "the force changes faster than the device may";
  if (now.work > mostWork(now.mode))
    return fmt::format("work of {}, beyond the bound of {}", now.work, mostWork(now.mode));
  return contactFault(now);
}

}  // namespace nearfit::stress
