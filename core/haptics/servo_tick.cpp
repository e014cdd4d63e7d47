#include "core/haptics/servo_tick.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "core/math/rotation_vector.h"
#include "core/proximity/blocked_minima.h"

namespace nearfit {
namespace {

bool isFinite(const glm::dvec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isFiniteAtLeast(double value, double lower) noexcept {
  return std::isfinite(value) && value >= lower;
}

bool isPose(const RigidTransform& pose) noexcept {
  const double lengthSquared = glm::dot(pose.rotation, pose.rotation);
  return pose.isFinite() && lengthSquared > 0.25 && lengthSquared < 4.0;
}

ServoFault faultOfInput(const ServoParameters& p, const RigidTransform& handle, double period) noexcept {
  const bool parametersAreValid =
      isFiniteAtLeast(p.haptics.springs.cutoff, std::numeric_limits<double>::min()) &&
      isFiniteAtLeast(p.haptics.springs.stiffness, 0.0) && isFiniteAtLeast(p.haptics.springs.damping, 0.0) &&
      isFiniteAtLeast(p.limits.maxForce, 0.0) && isFiniteAtLeast(p.limits.maxTorque, 0.0) &&
      isFiniteAtLeast(period, std::numeric_limits<double>::min());
  if (!parametersAreValid) return ServoFault::ParametersInvalid;
  return isPose(handle) ? ServoFault::None : ServoFault::PoseNotFinite;
}

/// A velocity that decays at rest would end, for good, among the denormals, where arithmetic is slow.
glm::dvec3 withoutTraces(const glm::dvec3& velocity) noexcept {
  return glm::length(velocity) < 1e-100 ? glm::dvec3(0.0) : velocity;
}

bool isNearer(const SnapshotLmd& a, const SnapshotLmd& b) noexcept {
  return a.lmd.distance < b.lmd.distance;
}

void clearOutputs(ServoSnapshot& snapshot) noexcept {
  snapshot.wrench = snapshot.unclampedWrench = Wrench{};
  snapshot.distance = std::numeric_limits<double>::infinity();
  snapshot.queryTime = 0.0;
  snapshot.lmdCount = snapshot.storedLmds = snapshot.lateBodies = 0;
  snapshot.isTruncated = snapshot.isClamped = false;
}

}  // namespace

const char* faultReason(ServoFault fault) noexcept {
  switch (fault) {
    case ServoFault::None:
      return "";
    case ServoFault::PoseNotFinite:
      return "a pose was not finite or not a rotation; check the device, then start the servo anew";
    case ServoFault::WrenchNotFinite:
      return "the force was not finite; lower stiffness or damping, then start the servo anew";
    case ServoFault::ParametersInvalid:
      return "cutoff, stiffness, damping, limits or period made no sense; set them, then start the servo "
             "anew";
  }
  return "unknown fault; start the servo anew";
}

ServoTick::ServoTick() : lmds_(kMaxLmdsPerBody), display_(2 * ServoSnapshot::kMaxLmds) {}

void ServoTick::reset() noexcept {
  hasLastPose_ = false;
  twist_ = Twist{};
  fault_ = ServoFault::None;
}

void ServoTick::run(const TrackedScene& tracked, const ServoParameters& parameters,
                    const RigidTransform& handle, double period, ServoSnapshot& snapshot) noexcept {
  const ServoScene& scene = *tracked.scene;
  clearOutputs(snapshot);
  snapshot.moving = scene.moving.id;
  if (scene.moving.id != lastMoving_) hasLastPose_ = false;
  lastMoving_ = scene.moving.id;

  if (fault_ == ServoFault::None) fault_ = faultOfInput(parameters, handle, period);
  if (fault_ == ServoFault::None) {
    const RigidTransform pose = handle.normalized();
    updateTwist(scene, pose, period);
  } else if (!hasLastPose_) {
    lastPose_ = scene.moving.worldFromPart;
  }
  snapshot.handle = snapshot.proxy = lastPose_;
  snapshot.centre = lastPose_.applyToPoint(scene.centreInPart);

  if (fault_ == ServoFault::None) {
    const Wrench wrench = feel(tracked, parameters.haptics.springs, snapshot);
    const bool wrenchIsFinite = isFinite(wrench.force) && isFinite(wrench.torque);
    if (fault_ == ServoFault::None && !wrenchIsFinite) fault_ = ServoFault::WrenchNotFinite;
    if (fault_ == ServoFault::None) {
      const LimitedWrench limited = limitWrench(wrench, parameters.limits);
      snapshot.unclampedWrench = wrench;
      snapshot.wrench = limited.wrench;
      snapshot.isClamped = limited.isClamped;
    }
  }
  snapshot.fault = fault_;
}

void ServoTick::updateTwist(const ServoScene& scene, const RigidTransform& pose, double period) noexcept {
  if (hasLastPose_) {
    const glm::dvec3 step =
        pose.applyToPoint(scene.centreInPart) - lastPose_.applyToPoint(scene.centreInPart);
    const glm::dvec3 turn = rotationVector(pose.rotation * glm::conjugate(lastPose_.rotation));
    const double share = period / (kVelocityTimeConstant + period);
    twist_.linear = withoutTraces(twist_.linear + share * (step / period - twist_.linear));
    twist_.angular = withoutTraces(twist_.angular + share * (turn / period - twist_.angular));
  } else {
    twist_ = Twist{};
  }
  lastPose_ = pose;
  hasLastPose_ = true;
}

Wrench ServoTick::feel(const TrackedScene& tracked, const SpringParameters& springs,
                       ServoSnapshot& snapshot) noexcept {
  using Clock = std::chrono::steady_clock;
  Wrench sum;
  displayCount_ = 0;
  displayWasCut_ = false;
  nodePairsLeft_ = kMaxNodePairs;
  const ServoScene::Body& moving = tracked.scene->moving;
  if (moving.geometry == nullptr) return sum;
  const Clock::time_point begin = Clock::now();
  tracked.visitNear(snapshot.proxy, springs.cutoff, [&](std::uint32_t body, const TrackedScene::Near* known) {
    const CandidateList* list = known != nullptr ? known->list.get() : nullptr;
    const Wrench wrench = feelBody({tracked.scene->bodies[body], moving, list}, springs, snapshot);
    sum.force += wrench.force;
    sum.torque += wrench.torque;
  });
  writeDisplay(snapshot);
  snapshot.queryTime = std::chrono::duration<double>(Clock::now() - begin).count();
  return sum;
}

LmdResult ServoTick::findMinima(const BodyTask& task, const RigidTransform& bodyFromPart, double cutoff,
                                ServoSnapshot& snapshot) noexcept {
  if (task.list != nullptr) {
    const std::optional<LmdResult> listed = task.list->query(bodyFromPart, cutoff, scratch_, lmds_);
    if (listed) return *listed;
  }
  ++snapshot.lateBodies;
  const LmdResult result = findNearestLmds(task.body.geometry->tree(), task.moving.geometry->tree(),
                                           bodyFromPart, cutoff, scratch_, lmds_, nodePairsLeft_);
  nodePairsLeft_ -= std::min(nodePairsLeft_, result.nodePairs);
  return result;
}

Wrench ServoTick::feelBody(const BodyTask& task, const SpringParameters& springs,
                           ServoSnapshot& snapshot) noexcept {
  const ServoScene::Body& body = task.body;
  const RigidTransform bodyFromPart = (body.worldFromPart.inverse() * snapshot.proxy).normalized();
  if (!isPose(body.worldFromPart) || !bodyFromPart.isFinite()) {
    fault_ = ServoFault::PoseNotFinite;
    return {};
  }
  const LmdResult result = findMinima(task, bodyFromPart, springs.cutoff, snapshot);
  const std::span<Lmd> found = std::span(lmds_).first(result.count);
  // Nothing keeps the part from going through: no distance can be taken for granted.
  constexpr double kMayInterpenetrate = 0.0;
  markBlocked(body.geometry->tree(), task.moving.geometry->tree(), bodyFromPart, found, kMayInterpenetrate,
              scratch_);
  for (Lmd& lmd : found) {
    lmd = transformed(lmd, body.worldFromPart);
    snapshot.distance = std::min(snapshot.distance, lmd.distance);
  }
  snapshot.lmdCount += static_cast<std::uint32_t>(result.count);
  if (result.status == QueryStatus::Truncated) snapshot.isTruncated = true;
  keepForDisplay(body.id, result.count);
  return springWrench(found, springs, snapshot.centre, twist_);
}

void ServoTick::keepForDisplay(PartId other, std::size_t count) noexcept {
  const std::size_t added = std::min(count, ServoSnapshot::kMaxLmds);
  for (std::size_t i = 0; i < added; ++i)
    display_[displayCount_ + i] = {lmds_[i], other};
  displayCount_ += added;
  if (displayCount_ <= ServoSnapshot::kMaxLmds) return;
  const auto begin = display_.begin();
  std::nth_element(begin, begin + static_cast<std::ptrdiff_t>(ServoSnapshot::kMaxLmds),
                   begin + static_cast<std::ptrdiff_t>(displayCount_), isNearer);
  displayCount_ = ServoSnapshot::kMaxLmds;
  displayWasCut_ = true;
}

void ServoTick::writeDisplay(ServoSnapshot& snapshot) noexcept {
  const std::span<SnapshotLmd> kept = std::span(display_).first(displayCount_);
  if (displayWasCut_) {
    std::sort(kept.begin(), kept.end(), [](const SnapshotLmd& a, const SnapshotLmd& b) {
      return a.other != b.other ? a.other < b.other : isNearer(a, b);
    });
  }
  std::copy(kept.begin(), kept.end(), snapshot.lmds.begin());
  snapshot.storedLmds = static_cast<std::uint32_t>(displayCount_);
}

}  // namespace nearfit
