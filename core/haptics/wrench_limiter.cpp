#include "core/haptics/wrench_limiter.h"

#include <cmath>

namespace nearfit {
namespace {

bool limitLength(glm::dvec3& v, double limit) noexcept {
  // hypot, since the square of a large finite number overflows and would turn the limit into zero.
  const double length = std::hypot(v.x, v.y, v.z);
  if (!(length > limit)) return false;
  v *= limit / length;
  return true;
}

}  // namespace

LimitedWrench limitWrench(const Wrench& wrench, const DeviceLimits& limits) noexcept {
  LimitedWrench result{wrench, false};
  const bool forceClamped = limitLength(result.wrench.force, limits.maxForce);
  const bool torqueClamped = limitLength(result.wrench.torque, limits.maxTorque);
  result.isClamped = forceClamped || torqueClamped;
  return result;
}

}  // namespace nearfit
