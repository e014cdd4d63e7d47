#include "core/servo/servo_faults.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>

namespace nearfit {
namespace {

constexpr double kPositive = std::numeric_limits<double>::min();

bool areFiniteAtLeast(double lower, std::initializer_list<double> values) noexcept {
  return std::all_of(values.begin(), values.end(),
                     [lower](double value) { return std::isfinite(value) && value >= lower; });
}

bool areValid(const HapticSettings& s) noexcept {
  const CouplingSettings& c = s.coupling;
  const glm::dquat& q = s.mapping.orientationOffset;
  const glm::dvec3& g = s.weight.gravity;
  return areFiniteAtLeast(kPositive, {s.springs.cutoff, s.proxy.margin, s.mapping.scale}) &&
         areFiniteAtLeast(0.0, {s.springs.stiffness, s.springs.damping, s.proxy.friction, c.stiffness,
                                c.damping, c.rotationalStiffness, c.rotationalDamping}) &&
         std::isfinite(g.x + g.y + g.z) && isPose({q, glm::dvec3(0.0)});
}

bool areValid(const DeviceLimits& l) noexcept {
  return areFiniteAtLeast(
      0.0, {l.maxForce, l.maxTorque, l.forceSlew, l.torqueSlew, l.damping, l.rotationalDamping});
}

}  // namespace

const char* faultReason(ServoFault fault) noexcept {
  switch (fault) {
    case ServoFault::None:
      return "";
    case ServoFault::PoseNotFinite:
      return "a pose was not finite or not a rotation; check the device, then start the servo again";
    case ServoFault::WrenchNotFinite:
      return "the force was not finite; lower stiffness or damping, then start the servo again";
    case ServoFault::ParametersInvalid:
      return "cutoff, margin, stiffness, damping, limits or period were invalid; correct them, then start "
             "the servo again";
  }
  return "unknown fault; start the servo again";
}

bool isPose(const RigidTransform& pose) noexcept {
  const double lengthSquared = glm::dot(pose.rotation, pose.rotation);
  return pose.isFinite() && lengthSquared > 0.25 && lengthSquared < 4.0;
}

ServoFault faultOfInput(const HapticSettings& settings, const DeviceLimits& limits,
                        const RigidTransform& devicePose, double period) noexcept {
  if (!areValid(settings) || !areValid(limits) || !areFiniteAtLeast(kPositive, {period}))
    return ServoFault::ParametersInvalid;
  return isPose(devicePose) ? ServoFault::None : ServoFault::PoseNotFinite;
}

}  // namespace nearfit
