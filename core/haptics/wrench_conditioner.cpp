#include "core/haptics/wrench_conditioner.h"

#include <algorithm>
#include <cmath>

#include "core/math/finite.h"

namespace nearfit {
namespace {

double zeroUnlessPositive(double value) noexcept {
  return value > 0.0 ? value : 0.0;
}

bool limitLength(glm::dvec3& v, double limit) noexcept {
  // Scale first: the square of a large finite number overflows, which would turn the limit into zero.
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0.0)) return false;
  const glm::dvec3 scaled = v / largest;
  const double length = std::hypot(scaled.x, scaled.y, scaled.z);
  const double bound = zeroUnlessPositive(limit) / largest;
  if (!(length > bound)) return false;
  v = scaled * (zeroUnlessPositive(limit) / length);
  return true;
}

/// `from`, moved towards `to` by at most `most`.
glm::dvec3 slewed(const glm::dvec3& from, const glm::dvec3& to, double most, bool& isSlewed) noexcept {
  glm::dvec3 change = to - from;
  if (!limitLength(change, most)) return to;
  isSlewed = true;
  return from + change;
}

/// Share of the wanted wrench that an input of that age is worth; 0 if any number is NaN.
double worthOf(double age, const PoseFade& patience) noexcept {
  if (!(age < patience.silence)) return 0.0;
  if (std::isnan(patience.hold)) return 0.0;
  // An infinite silence never fades; the line below would make NaN of it.
  if (!(age > patience.hold) || std::isinf(patience.silence)) return 1.0;
  return (patience.silence - age) / (patience.silence - patience.hold);
}

double smoothStep(double t) noexcept {
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

LimitedWrench limitWrench(const Wrench& wrench, const DeviceLimits& limits) noexcept {
  LimitedWrench result{wrench, false};
  const bool forceClamped = limitLength(result.wrench.force, limits.maxForce);
  const bool torqueClamped = limitLength(result.wrench.torque, limits.maxTorque);
  result.isClamped = forceClamped || torqueClamped;
  return result;
}

void WrenchConditioner::engage() noexcept {
  isEngaged_ = true;
  ramp_ = 0.0;
  freshness_ = 1.0;
}

void WrenchConditioner::disengage() noexcept {
  isEngaged_ = false;
}

double WrenchConditioner::nextGain(double inputAge, double period, const PoseFade& patience) noexcept {
  // Falls with the age at once but rises only in time; otherwise each report of a stuttering device
  // would be a knock.
  freshness_ = std::min(worthOf(inputAge, patience), freshness_ + period / kRecoveryTime);
  const double gain = smoothStep(ramp_) * freshness_;
  ramp_ = std::min(1.0, ramp_ + period / kRampTime);
  return gain;
}

ConditionedWrench WrenchConditioner::condition(const Wrench& wanted, double inputAge, double period,
                                               const DeviceLimits& limits,
                                               const PoseFade& patience) noexcept {
  ConditionedWrench result;
  if (!isFinite(wanted.force) || !isFinite(wanted.torque)) {
    last_ = Wrench{};
    ramp_ = 0.0;
    result.isFinite = false;
    return result;
  }
  const double elapsed = std::isfinite(period) ? zeroUnlessPositive(period) : 0.0;
  const double gain = isEngaged_ ? nextGain(inputAge, elapsed, patience) : 0.0;
  const LimitedWrench clamped = limitWrench({gain * wanted.force, gain * wanted.torque}, limits);
  result.isClamped = clamped.isClamped;
  last_.force = slewed(last_.force, clamped.wrench.force, limits.forceSlew * elapsed, result.isSlewed);
  last_.torque = slewed(last_.torque, clamped.wrench.torque, limits.torqueSlew * elapsed, result.isSlewed);
  // On the way from one wrench to the next the limits hold anyway, unless they have just been lowered.
  last_ = limitWrench(last_, limits).wrench;
  result.wrench = last_;
  return result;
}

}  // namespace nearfit
