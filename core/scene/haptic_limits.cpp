#include "core/scene/haptic_limits.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/scene/scene.h"

namespace nearfit {
namespace {

void checkWithin(const char* where, double value, double lower, double upper, const char* unit) {
  if (value >= lower && value <= upper) return;
  const std::string suffix = *unit == '\0' ? "" : std::string(" ") + unit;
  throw UsageError(where, fmt::format("{}{} is out of range", value, suffix),
                   fmt::format("give a value from {} to {}{}", lower, upper, suffix));
}

void checkSprings(const SpringParameters& springs) {
  const bool isPrinted = springs.law == SpringLaw::Printed;
  checkWithin("springs.cutoff", springs.cutoff, kMinCutoff, kMaxCutoff, "m");
  checkWithin("springs.stiffness", springs.stiffness, kMinStiffness,
              isPrinted ? kMaxPrintedStiffness : kMaxStiffness, isPrinted ? "N/m^2" : "N/m");
  checkWithin("springs.damping", springs.damping, kMinDamping, kMaxDamping, "N s/m");
}

void checkProxy(const ProxySettings& proxy, double cutoff) {
  checkWithin("proxy.margin", proxy.margin, kMinMargin, kMaxMargin, "m");
  checkWithin("proxy.friction", proxy.friction, kMinFriction, kMaxFriction, "");
  if (proxy.margin <= cutoff) return;
  throw UsageError(
      "proxy.margin", fmt::format("{} m is greater than the cutoff, {} m", proxy.margin, cutoff),
      fmt::format("lower the margin, for example to {} m, or raise the cutoff", defaultMargin(cutoff)));
}

void checkCoupling(const CouplingSettings& coupling) {
  checkWithin("coupling.stiffness", coupling.stiffness, kMinStiffness, kMaxStiffness, "N/m");
  checkWithin("coupling.damping", coupling.damping, kMinDamping, kMaxDamping, "N s/m");
  checkWithin("coupling.rotationalStiffness", coupling.rotationalStiffness, kMinRotationalStiffness,
              kMaxRotationalStiffness, "N m/rad");
  checkWithin("coupling.rotationalDamping", coupling.rotationalDamping, kMinRotationalDamping,
              kMaxRotationalDamping, "N m s/rad");
}

void checkGravity(const glm::dvec3& gravity) {
  // Check coordinates first: the length of huge ones would overflow.
  for (const double coordinate : {gravity.x, gravity.y, gravity.z})
    checkWithin("weight.gravity", coordinate, -kMaxGravity, kMaxGravity, "m/s^2");
  checkWithin("weight.gravity", glm::length(gravity), 0.0, kMaxGravity, "m/s^2");
}

void checkMapping(const WorkspaceMapping& mapping) {
  checkWithin("mapping.scale", mapping.scale, kMinScale, kMaxScale, "");
  try {
    checkedPose({mapping.orientationOffset, {}});
  } catch (const UsageError& e) {
    throw UsageError("mapping.orientation", e.problem(), e.remedy());
  }
}

}  // namespace

double defaultMargin(double cutoff) noexcept {
  constexpr double kShareOfCutoff = 0.01;
  return std::clamp(kShareOfCutoff * cutoff, kMinMargin, kMaxMargin);
}

SpringParameters withLaw(SpringParameters springs, SpringLaw law) noexcept {
  if (springs.law == law) return springs;
  springs.law = law;
  springs.stiffness = law == SpringLaw::Printed
                          ? std::min(4.0 * springs.stiffness / springs.cutoff, kMaxPrintedStiffness)
                          : std::min(0.25 * springs.stiffness * springs.cutoff, kMaxStiffness);
  return springs;
}

void checkHaptics(const HapticSettings& settings) {
  checkSprings(settings.springs);
  checkProxy(settings.proxy, settings.springs.cutoff);
  checkCoupling(settings.coupling);
  checkGravity(settings.weight.gravity);
  checkMapping(settings.mapping);
}

}  // namespace nearfit
