#include "app/cli/device_push.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "app/cli/interrupt.h"
#include "core/math/rotation_vector.h"
#include "device/thread/monotonic_clock.h"

namespace nearfit::cli {
namespace {

using PushResult = TestStep::Result;

constexpr double kTestForce = 0.5, kTestTorque = 0.05;  // [N], [N m]
/// Sizes of the first pushes of a device that nobody has felt yet [N], [N m].
constexpr std::array kFirstForces = {0.1, 0.2, 0.3}, kFirstTorques = {0.01, 0.02, 0.03};
constexpr double kPushSeconds = 1.0;

/// Limits for half a newton on a handle that is held.
constexpr double kMaxWay = 0.05, kMaxSpeed = 0.5;  // [m], [m/s]
/// The same for a twentieth of a newton metre.
constexpr double kMaxTurn = 0.8, kMaxTurnSpeed = 5.0;  // [rad], [rad/s]
/// Farther than a hand that is pushed one way drifts the other way within a second [m], [rad].
constexpr double kWayAgainst = 2e-3, kTurnAgainst = 0.1;

constexpr int kLatencyPushes = 9;
/// Longest wait for the handle to move, and rest between two pushes: a hand swings out within it [s].
constexpr double kStartSeconds = 0.1, kRestSeconds = 0.2;
/// Motion that noise does not make: in a million readings one lies beyond five times the rms. At least what the encoders
/// of such devices resolve.
constexpr double kClearOfNoise = 5.0, kLeastStart = 2e-5;  // [1], [m]

/// Watches a handle that is pushed.
class PushWatch {
 public:
  PushWatch(const TickedDevice& ticked, bool watchesTurns)
      : from_(ticked.handle().pose), watchesTurns_(watchesTurns) {}

  /// Takes the last tick. Returns why the push is given up; empty if it goes on.
  std::string trouble(TickedDevice& ticked) {
    if (InterruptGuard::isInterrupted()) return "interrupted";
    if (ticked.device().state() != DeviceState::Armed) {
      const std::string note = ticked.device().stateNote();
      return note.empty() ? "it is no longer armed" : note;
    }
    const RigidTransform& pose = ticked.handle().pose;
    const Nanoseconds now = monotonicNow();
    shift_ = pose.translation - from_.translation;
    const double way = glm::length(shift_), speed = speed_.see(shift_, now);
    if (!(way <= kMaxWay)) return fmt::format("the handle moved {:.3f} m: hold it", way);
    if (!(speed <= kMaxSpeed)) return fmt::format("the handle ran away at {:.2f} m/s", speed);
    if (!watchesTurns_) return {};
    turn_ = rotationVector(pose.rotation * glm::conjugate(from_.rotation));
    const double angle = glm::length(turn_), turnSpeed = turnSpeed_.see(turn_, now);
    if (!(angle <= kMaxTurn)) return fmt::format("the handle turned by {:.2f} rad: hold it", angle);
    if (!(turnSpeed <= kMaxTurnSpeed)) return fmt::format("the handle spun at {:.1f} rad/s", turnSpeed);
    return {};
  }
  /// Since the beginning [m], [rad].
  const glm::dvec3& shift() const noexcept { return shift_; }
  const glm::dvec3& turn() const noexcept { return turn_; }

 private:
  RigidTransform from_;
  bool watchesTurns_;
  SpeedMeter speed_, turnSpeed_;
  glm::dvec3 shift_{0.0}, turn_{0.0};
};

Wrench wrenchOf(const DevicePush& push, double share) noexcept {
  const glm::dvec3 load = share * push.size * push.axis;
  return push.isTurn ? Wrench{glm::dvec3(0.0), load} : Wrench{load, glm::dvec3(0.0)};
}

/// @param farthest  Motion of the handle [m], [rad].
TestStep judgePush(const DevicePush& push, const glm::dvec3& farthest) {
  const char* const unit = push.isTurn ? "rad" : "m";
  if (glm::dot(farthest, push.axis) < -(push.isTurn ? kTurnAgainst : kWayAgainst)) {
    return {push.name, PushResult::Failed,
            fmt::format("the handle moved against the {}: ({:.4f}, {:.4f}, {:.4f}) {}",
                        push.isTurn ? "torque" : "force", farthest.x, farthest.y, farthest.z, unit)};
  }
  return {push.name, PushResult::Passed,
          fmt::format("up to {:.2f} {}, the handle moved up to {:.4f} {}", push.size,
                      push.isTurn ? "N m" : "N", glm::length(farthest), unit)};
}

/// Lets a handle come to rest without force. Returns false if the device is lost.
bool restHandle(TickedDevice& ticked) {
  const Nanoseconds begin = monotonicNow();
  while (toSeconds(monotonicNow() - begin) < kRestSeconds && !InterruptGuard::isInterrupted())
    if (!ticked.tick()) return false;
  return true;
}

struct HandleStart {
  std::string trouble;         ///< Why it was given up; empty if it was not.
  std::optional<double> time;  ///< From the force until the motion was measured [s]; empty if there was none.
};

/// Pushes suddenly until the handle moves.
/// @param clear  Motion that counts [m].
HandleStart startHandle(TickedDevice& ticked, const DevicePush& push, double clear) {
  const Wrench wrench = wrenchOf(push, 1.0);
  // The pose of this tick is from before the force, which goes out at its end.
  if (!ticked.tick(wrench)) return {ticked.device().stateNote(), std::nullopt};
  const Nanoseconds begin = monotonicNow();
  PushWatch watch(ticked, false);
  HandleStart start;
  while (!start.time && start.trouble.empty() && toSeconds(monotonicNow() - begin) < kStartSeconds) {
    if (!ticked.tick(wrench)) return {ticked.device().stateNote(), std::nullopt};
    const double measured = toSeconds(monotonicNow() - begin) - ticked.handle().age;
    start.trouble = watch.trouble(ticked);
    if (glm::dot(watch.shift(), push.axis) > clear) start.time = std::max(measured, 0.0);
  }
  ticked.tick();
  return start;
}

}  // namespace

double testForceOf(const DeviceInfo& info) {
  return info.forceAxes == 0 ? 0.0 : std::min(kTestForce, info.limits.maxForce);
}

double testTorqueOf(const DeviceInfo& info) {
  return info.forceAxes < 6 ? 0.0 : std::min(kTestTorque, info.limits.maxTorque);
}

std::vector<DevicePush> pushesOf(const DeviceInfo& info, bool isGradual) {
  const double force = testForceOf(info), torque = testTorqueOf(info);
  constexpr std::array<const char*, 3> kNames = {"x", "y", "z"};
  const std::array<glm::dvec3, 3> axes = {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0),
                                          glm::dvec3(0.0, 0.0, 1.0)};
  std::vector<DevicePush> pushes;
  if (force > 0.0 && isGradual) {
    for (const double first : kFirstForces)
      pushes.push_back({fmt::format("push {:.1f} N", first), axes[2], std::min(first, force)});
  }
  for (std::size_t i = 0; force > 0.0 && i < axes.size(); ++i)
    pushes.push_back({fmt::format("push {}", kNames[i]), axes[i], force});
  if (torque > 0.0 && isGradual) {
    for (const double first : kFirstTorques)
      pushes.push_back({fmt::format("twist {:.2f} N m", first), axes[2], std::min(first, torque), true});
  }
  for (std::size_t i = 0; torque > 0.0 && i < axes.size(); ++i)
    pushes.push_back({fmt::format("twist {}", kNames[i]), axes[i], torque, true});
  return pushes;
}

TestStep pushHandle(TickedDevice& ticked, const DevicePush& push) {
  PushWatch watch(ticked, push.isTurn);
  glm::dvec3 farthest(0.0);
  std::uint64_t ticks = 0, held = 0;
  const Nanoseconds begin = monotonicNow();
  for (double time = 0.0; time < kPushSeconds; time = toSeconds(monotonicNow() - begin)) {
    const double share = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * time / kPushSeconds);
    if (!ticked.tick(wrenchOf(push, share)))
      return {push.name, PushResult::Failed, ticked.device().stateNote()};
    if (const std::string trouble = watch.trouble(ticked); !trouble.empty()) {
      ticked.tick();
      return {push.name, PushResult::Failed, trouble};
    }
    const glm::dvec3& motion = push.isTurn ? watch.turn() : watch.shift();
    if (glm::length(motion) > glm::length(farthest)) farthest = motion;
    ++ticks;
    held += ticked.handle().isArmed ? 1 : 0;
  }
  ticked.tick();
  if (2 * held < ticks)
    return {push.name, PushResult::Failed, "it exerted no force: hold its dead-man's switch"};
  return judgePush(push, farthest);
}

TestStep measureLatency(TickedDevice& ticked, double force, double noise) {
  const double clear = std::max(kLeastStart, kClearOfNoise * noise);
  std::vector<double> times;
  for (int i = 0; i < kLatencyPushes; ++i) {
    if (!restHandle(ticked)) return {"latency", PushResult::Failed, ticked.device().stateNote()};
    const DevicePush push{"latency", {i % 2 == 0 ? 1.0 : -1.0, 0.0, 0.0}, force};
    const HandleStart start = startHandle(ticked, push, clear);
    if (!start.trouble.empty()) return {"latency", PushResult::Failed, start.trouble};
    if (start.time) times.push_back(*start.time);
  }
  if (times.empty()) {
    return {"latency", PushResult::Skipped,
            fmt::format("no push of {:.2f} N moved the handle by {:.3f} mm: hold it loosely", force,
                        1e3 * clear)};
  }
  std::sort(times.begin(), times.end());
  return {"latency", PushResult::Passed,
          fmt::format("from a force of {:.2f} N until its handle was {:.3f} mm away: median {:.1f} ms, max "
                      "{:.1f} ms ({} of {} pushes)",
                      force, 1e3 * clear, 1e3 * times[times.size() / 2], 1e3 * times.back(), times.size(),
                      kLatencyPushes)};
}

}  // namespace nearfit::cli
