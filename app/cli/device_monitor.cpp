#include "app/cli/device_monitor.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/cli/device_armer.h"
#include "app/cli/interrupt.h"
#include "app/cli/output.h"
#include "app/cli/ticked_device.h"
#include "device/interface/device_error.h"

namespace nearfit::cli {
namespace {

/// How often a person can read a line, and how often a file needs one.
constexpr Nanoseconds kRewriteEvery = kNanosecondsPerSecond / 10, kLineEvery = kNanosecondsPerSecond / 2;

/// State of the forces, with the reason if none go out.
enum class Forces : std::uint8_t {
  None,  ///< The device has none.
  Off,   ///< The device is not armed.
  Held,  ///< The device is armed, but its dead-man switch is not held.
  Out,
};

const char* nameOf(Forces forces) noexcept {
  switch (forces) {
    case Forces::None:
      return "none";
    case Forces::Off:
      return "off";
    case Forces::Held:
      return "held back";
    case Forces::Out:
      return "out";
  }
  return "";
}

Forces forcesOf(TickedDevice& ticked) {
  if (ticked.device().info().forceAxes == 0) return Forces::None;
  if (ticked.device().state() != DeviceState::Armed) return Forces::Off;
  return ticked.handle().isArmed ? Forces::Out : Forces::Held;
}

struct Look {
  double time = 0.0;  ///< Since the start [s].
  double rate = 0.0;  ///< [Hz]
  HandleInput handle;
  ReportCounters counters;
  double intervalP50 = 0.0, intervalP99 = 0.0;  ///< [s]
  DeviceState state{};
  std::string note;
  Forces forces = Forces::Off;
  glm::dvec3 force{0.0};  ///< Last one sent to the device [N]; valid if forces are out.
};

Look lookAt(TickedDevice& ticked, const glm::dvec3& force, double time, Nanoseconds now) {
  ReportMeter& meter = ticked.meter();
  const HapticDevice& device = ticked.device();
  return {time,
          meter.takeRate(now),
          ticked.handle(),
          device.counters(),
          meter.intervals().percentile(0.5),
          meter.intervals().percentile(0.99),
          device.state(),
          device.stateNote(),
          forcesOf(ticked),
          force};
}

std::string forceText(const Look& look) {
  if (look.forces != Forces::Out) return std::string("force ") + nameOf(look.forces);
  return fmt::format("force {:+.3f} {:+.3f} {:+.3f} N", look.force.x, look.force.y, look.force.z);
}

std::string gripText(const Look& look) {
  return look.handle.grip ? fmt::format("  grip {:.3f} rad", *look.handle.grip) : std::string();
}

std::string textOf(const Look& look) {
  const RigidTransform& pose = look.handle.pose;
  std::string text = fmt::format(
      "{:8.2f} s  {:+.4f} {:+.4f} {:+.4f} m  {:+.3f} {:+.3f} {:+.3f} {:+.3f}  {:6.1f} Hz  p50 {:.2f} p99 "
      "{:.2f} ms  buttons {:b}{}  {}  {}",
      look.time, pose.translation.x, pose.translation.y, pose.translation.z, pose.rotation.w, pose.rotation.x,
      pose.rotation.y, pose.rotation.z, look.rate, 1e3 * look.intervalP50, 1e3 * look.intervalP99,
      look.handle.buttons, gripText(look), forceText(look), stateName(look.state));
  if (!look.note.empty()) text += ": " + look.note;
  return text;
}

std::string lookJson(const Look& look) {
  const RigidTransform& pose = look.handle.pose;
  nlohmann::ordered_json json{
      {"t_s", look.time},
      {"pose",
       {pose.translation.x, pose.translation.y, pose.translation.z, pose.rotation.w, pose.rotation.x,
        pose.rotation.y, pose.rotation.z}},
      {"rate", look.rate},
      {"interval_ms", {{"p50", 1e3 * look.intervalP50}, {"p99", 1e3 * look.intervalP99}}},
      {"reports", look.counters.poses},
      {"rejected", look.counters.rejected},
      {"missing", look.counters.missing},
      {"buttons", look.handle.buttons},
      {"grip", nullptr},
      {"forces", nameOf(look.forces)},
      {"force", nullptr},
      {"state", stateName(look.state)},
      {"note", look.note}};
  if (look.handle.grip) json["grip"] = *look.handle.grip;
  if (look.forces == Forces::Out) json["force"] = {look.force.x, look.force.y, look.force.z};
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void requireForces(const HapticDevice& device, const MonitorOptions& options) {
  if (!options.isArming || device.info().forceAxes > 0) return;
  throw UsageError("--arm", device.info().name + " does not push", "leave it out");
}

std::string heading(const HapticDevice& device, const MonitorOptions& options) {
  const char* forces = options.isArming
                           ? "it is armed as soon as it is ready, then resists motion weakly: hold its handle"
                           : "its forces are off";
  return oneLine(device.info().name) + ": " + forces + "; press Ctrl+C to end\n";
}

}  // namespace

Wrench MonitorDamping::step(const HandleInput& handle, bool isArmed, Nanoseconds now) noexcept {
  const auto age = static_cast<Nanoseconds>(std::clamp(handle.age, 0.0, 1.0) * 1e9);
  const glm::dvec3 velocity = velocity_.update(handle.pose.translation, now - age);
  if (!isArmed || !handle.isArmed || handle.isClutched) {
    pushingSince_ = 0;
    return {};
  }
  if (pushingSince_ == 0) pushingSince_ = now;
  const double speed = glm::length(velocity);
  // NaN gives no force.
  if (!(speed > 0.0 && speed < kNoneFrom) || !(handle.age <= kFresh)) return {};
  const double in = std::min(toSeconds(now - pushingSince_) / kFadeIn, 1.0);
  const double slow = std::clamp((kNoneFrom - speed) / (kNoneFrom - kAllUpTo), 0.0, 1.0);
  const double size = in * slow * std::min(kDamping * speed, kMax);
  return {-size / speed * velocity, glm::dvec3(0.0)};
}

const char* stateName(DeviceState state) noexcept {
  switch (state) {
    case DeviceState::Absent:
      return "absent";
    case DeviceState::Present:
      return "present";
    case DeviceState::Opening:
      return "opening";
    case DeviceState::Uncalibrated:
      return "uncalibrated";
    case DeviceState::Ready:
      return "ready";
    case DeviceState::Armed:
      return "armed";
    case DeviceState::Fault:
      return "fault";
    case DeviceState::Lost:
      return "lost";
  }
  return "";
}

void monitorDevice(HapticDevice& device, const MonitorOptions& options) {
  const InterruptGuard guard;
  TickedDevice ticked(device, options.isCalibrating);
  const bool isRewritten = !options.isJson && ::isatty(STDOUT_FILENO) == 1;
  requireForces(device, options);
  if (!options.isJson) print(heading(device, options));
  DeviceArmer armer(device, options.isArming);
  MonitorDamping damping;
  Wrench wrench;
  const Nanoseconds begin = monotonicNow(), every = isRewritten ? kRewriteEvery : kLineEvery;
  Nanoseconds next = begin + every;
  bool isThere = true;
  while (isThere && !InterruptGuard::isInterrupted()) {
    const std::string refusal = armer.poll();
    if (!refusal.empty()) throw DeviceError(DeviceProblem::Failed, device.info().name, refusal);
    isThere = ticked.tick(wrench);
    const glm::dvec3 sent = wrench.force;
    const Nanoseconds now = monotonicNow();
    wrench = damping.step(ticked.handle(), device.state() == DeviceState::Armed, now);
    const double time = toSeconds(now - begin);
    const bool isOver = options.seconds && time >= *options.seconds;
    if (now < next && !isOver && isThere) continue;
    next += every * ((now - next) / every + 1);
    const Look look = lookAt(ticked, sent, time, now);
    // Goes to the line's start, and clears what a longer line left behind.
    if (options.isJson)
      print(lookJson(look));
    else
      print(isRewritten ? "\r" + oneLine(textOf(look)) + "\033[K" : oneLine(textOf(look)) + "\n");
    flushOutput();
    if (isOver) break;
  }
  if (isRewritten) print("\n");
  if (!isThere)
    throw DeviceError(DeviceProblem::Gone, device.info().name, device.stateNote(), "plug it in again");
}

}  // namespace nearfit::cli
