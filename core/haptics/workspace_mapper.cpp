#include "core/haptics/workspace_mapper.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/quaternion.hpp>

namespace nearfit {
namespace {

using Locks = std::array<bool, 3>;

/// A twist is well defined while the squared length of its part of the quaternion is above this: the squared
/// cosine of half a quarter turn.
constexpr double kMinTwistSquared = 0.5;
/// Below this it is undefined, as after a jump of half a turn within one call.
constexpr double kNoTwistSquared = 1e-12;

bool isSame(const WorkspaceMapping& a, const WorkspaceMapping& b) noexcept {
  return a.scale == b.scale && a.orientationOffset == b.orientationOffset &&
         a.translationLocks == b.translationLocks && a.rotationLocks == b.rotationLocks;
}

bool changesNothing(const WorkspaceMapping& mapping) noexcept {
  return isSame(mapping, WorkspaceMapping{});
}

glm::dvec3 withoutLocked(glm::dvec3 v, const Locks& locks) noexcept {
  for (int i = 0; i < 3; ++i) {
    if (locks[static_cast<std::size_t>(i)]) v[i] = 0.0;
  }
  return v;
}

double validScale(double scale) noexcept {
  return std::isfinite(scale) && scale > 0.0 ? scale : 1.0;
}

/// Result of freeTurn().
struct FreeTurn {
  glm::dquat turn;
  bool isFar;      ///< A new index is needed.
  bool isDefined;  ///< If false, `turn` has no meaning.
};

/// The rotation that remains of `turn` without rotation about the locked axes.
FreeTurn freeTurn(const glm::dquat& turn, const Locks& locks) noexcept {
  const auto locked = std::count(locks.begin(), locks.end(), true);
  if (locked == 0) return {turn, false, true};
  if (locked == 3) return {{1.0, 0.0, 0.0, 0.0}, false, true};
  // The single locked axis, or the single free one.
  const auto axis = static_cast<int>(std::find(locks.begin(), locks.end(), locked == 1) - locks.begin());
  const glm::dvec3 imaginary(turn.x, turn.y, turn.z);
  glm::dvec3 along(0.0);
  along[axis] = imaginary[axis];
  const double squared = turn.w * turn.w + along[axis] * along[axis];
  if (squared < kNoTwistSquared) return {turn, true, false};
  const glm::dquat twist = glm::dquat(turn.w, along) / std::sqrt(squared);
  return {locked == 1 ? turn * glm::conjugate(twist) : twist, squared < kMinTwistSquared, true};
}

}  // namespace

void WorkspaceMapper::engageAt(const RigidTransform& device, const RigidTransform& worldFromPart,
                               const glm::dvec3& pivotInPart) noexcept {
  pivot_ = pivotInPart;
  setIndex(device, worldFromPart);
  isDirect_ = device == worldFromPart;
  lastDevice_ = device;
  lastHandle_ = worldFromPart;
  hasMapping_ = false;
  isEngaged_ = true;
}

void WorkspaceMapper::setIndex(const RigidTransform& device, const RigidTransform& handle) noexcept {
  indexDevice_ = device.normalized();
  indexHandle_ = handle.normalized();
  isDirect_ = false;
}

RigidTransform WorkspaceMapper::sinceIndex(const RigidTransform& device, bool& isFarTurned) const noexcept {
  const glm::dquat offset = glm::normalize(mapping_.orientationOffset);
  const glm::dvec3 shift = mapping_.scale * (offset * (device.translation - indexDevice_.translation));
  const glm::dquat turn = glm::normalize(offset * device.rotation * glm::conjugate(indexDevice_.rotation) *
                                         glm::conjugate(offset));
  const FreeTurn free = freeTurn(turn, mapping_.rotationLocks);
  isFarTurned = free.isFar;
  const glm::dquat rotation =
      free.isDefined ? glm::normalize(free.turn * indexHandle_.rotation) : lastHandle_.rotation;
  const glm::dvec3 pivot =
      indexHandle_.applyToPoint(pivot_) + withoutLocked(shift, mapping_.translationLocks);
  return {rotation, pivot - rotation * pivot_};
}

RigidTransform WorkspaceMapper::map(const RigidTransform& device, bool isClutched,
                                    const WorkspaceMapping& mapping) noexcept {
  if (!device.isFinite()) return device;
  if (!isEngaged_) engage(device);
  // At the previous pose, so that the motion of this tick counts under the new mapping.
  if (hasMapping_ && !isSame(mapping, mapping_)) setIndex(lastDevice_, lastHandle_);
  mapping_ = mapping;
  hasMapping_ = true;
  if (isClutched) {
    setIndex(device, lastHandle_);
    lastDevice_ = device;
    return lastHandle_;
  }
  bool isFarTurned = false;
  const RigidTransform handle =
      isDirect_ && changesNothing(mapping) ? device : sinceIndex(device, isFarTurned);
  if (!handle.isFinite()) return handle;
  if (isFarTurned) setIndex(device, handle);
  lastDevice_ = device;
  lastHandle_ = handle;
  return handle;
}

DeviceLimits limitsAtHandle(const DeviceLimits& device, double scale) noexcept {
  const double s = validScale(scale);
  DeviceLimits limits = device;
  limits.damping /= s;
  limits.leastMass /= s;
  limits.rotationalDamping *= s;
  limits.leastInertia *= s;
  limits.maxTorque *= s;
  limits.torqueSlew *= s;
  return limits;
}

Wrench wrenchOnDevice(const Wrench& wrench, const WorkspaceMapping& mapping) noexcept {
  const glm::dquat deviceFromWorld = glm::conjugate(glm::normalize(mapping.orientationOffset));
  return {deviceFromWorld * withoutLocked(wrench.force, mapping.translationLocks),
          deviceFromWorld * withoutLocked(wrench.torque, mapping.rotationLocks) / validScale(mapping.scale)};
}

}  // namespace nearfit
