#include "core/scene/part.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/scene/names.h"

namespace nearfit {

bool differsOnlyInLookOrLock(const Part& a, const Part& b) noexcept {
  return a.id == b.id && a.name == b.name && a.geometry == b.geometry && a.worldFromPart == b.worldFromPart &&
         a.density == b.density && a.pivot == b.pivot && a.group == b.group;
}

bool isSame(const Part& a, const Part& b) noexcept {
  return differsOnlyInLookOrLock(a, b) && a.colour == b.colour && a.opacity == b.opacity &&
         a.isVisible == b.isVisible && a.isLocked == b.isLocked && a.wasVisible == b.wasVisible;
}

double massOf(const Part& part) noexcept {
  return part.geometry != nullptr ? part.density * part.geometry->mass.volume : 0.0;
}

void checkDensity(double density) {
  if (density >= kMinDensity && density <= kMaxDensity) return;
  throw UsageError("density", fmt::format("{} kg/m^3 is out of range", density),
                   fmt::format("give a value from {} to {} kg/m^3", kMinDensity, kMaxDensity));
}

void checkOpacity(double opacity) {
  if (opacity >= kMinOpacity && opacity <= 1.0) return;
  throw UsageError("opacity", fmt::format("{} is out of range", opacity),
                   fmt::format("give a value from {} to 1; hide the part to make it invisible", kMinOpacity));
}

void checkColour(const Colour& colour) {
  for (const float channel : {colour.r, colour.g, colour.b}) {
    if (!(channel >= 0.0F && channel <= 1.0F)) {
      throw UsageError("colour", fmt::format("a channel of {} is out of range", channel),
                       "give r, g and b from 0 to 1");
    }
  }
}

void checkPartName(const std::string& name) {
  checkName("part", name, kMaxPartNameBytes);
}

void checkGroupName(const std::string& name) {
  checkName("group", name, kMaxGroupNameBytes);
}

void checkPosition(const glm::dvec3& position) {
  for (const double coordinate : {position.x, position.y, position.z}) {
    if (std::isfinite(coordinate) && std::abs(coordinate) <= kMaxPosition) continue;
    throw UsageError("position", fmt::format("a coordinate of {} m is out of range", coordinate),
                     fmt::format("stay within {} m of the origin", kMaxPosition));
  }
}

RigidTransform checkedPose(const RigidTransform& pose) {
  checkPosition(pose.translation);
  const double length = std::sqrt(glm::dot(pose.rotation, pose.rotation));
  if (!(std::abs(length - 1.0) <= kQuaternionSlack)) {
    throw UsageError("quaternion", fmt::format("its length is {}, not 1", length),
                     "give a unit quaternion in the order w, x, y, z");
  }
  // Keep a quaternion that is unit up to rounding, so that saving and loading changes no digit.
  return std::abs(length - 1.0) <= 1e-15 ? pose : pose.normalized();
}

}  // namespace nearfit
