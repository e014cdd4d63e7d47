#include "app/cli/device_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <unistd.h>

#include "app/cli/device_monitor.h"
#include "app/cli/device_report.h"
#include "app/cli/interrupt.h"
#include "app/cli/output.h"
#include "app/cli/ticked_device.h"
#include "core/base/error.h"
#include "device/interface/device_supervisor.h"

namespace nearfit::cli {
namespace {

using Result = TestStep::Result;

/// Strength of the pushes [N]: clearly felt, and dangerous to nobody.
constexpr double kTestForce = 0.5;
/// Strengths of the first pushes of a device that a report is for: nobody has felt it yet [N].
constexpr std::array kFirstForces = {0.1, 0.2, 0.3};

constexpr double kWatchSeconds = 2.0, kPushSeconds = 1.0;
/// The servo copes with half the nominal rate, with softer contact; less means a bad cable or hub.
constexpr double kMinRate = 0.5;
/// Shortest time over which speed is measured, since two reports may come at once [s].
constexpr double kSpeedTime = 0.01;
/// Limits for half a newton on a handle that is held.
constexpr double kMaxWay = 0.05, kMaxSpeed = 0.5;  // [m], [m/s]

/// Measures the speed of a handle from its poses.
class SpeedMeter {
 public:
  /// Returns the speed [m/s]; the last one if too little time has passed.
  double see(const glm::dvec3& position, Nanoseconds now) noexcept {
    const double time = toSeconds(now - time_);
    if (time_ == 0 || time >= kSpeedTime) {
      if (time_ != 0) speed_ = glm::length(position - position_) / time;
      position_ = position;
      time_ = now;
    }
    return speed_;
  }

 private:
  glm::dvec3 position_{0.0};
  Nanoseconds time_ = 0;
  double speed_ = 0.0;
};

struct Watched {
  double seconds = 0.0, rate = 0.0, mostSpeed = 0.0;
  bool isLost = false, isFinite = true;
  ReportCounters counters;
};

Watched watchTicks(TickedDevice& ticked) {
  Watched watched;
  const ReportCounters before = ticked.device().counters();
  SpeedMeter speed;
  const Nanoseconds begin = monotonicNow();
  while (watched.seconds < kWatchSeconds && !InterruptGuard::isInterrupted()) {
    if (!ticked.tick()) {
      watched.isLost = true;
      break;
    }
    const Nanoseconds now = monotonicNow();
    const RigidTransform& pose = ticked.handle().pose;
    watched.isFinite = watched.isFinite && pose.isFinite();
    // std::fmax ignores NaN; isFinite reports it.
    watched.mostSpeed = std::fmax(watched.mostSpeed, speed.see(pose.translation, now));
    watched.seconds = toSeconds(now - begin);
  }
  const ReportCounters after = ticked.device().counters();
  watched.counters = {after.poses - before.poses, after.rejected - before.rejected,
                      after.missing - before.missing};
  if (watched.seconds > 0.0) watched.rate = static_cast<double>(watched.counters.poses) / watched.seconds;
  return watched;
}

TestStep judgeRate(const TickedDevice& ticked, const Watched& watched, double period,
                   const std::string& note) {
  TestStep step{"reports", Result::Passed, {}};
  const LatencyHistogram& intervals = ticked.meter().intervals();
  step.text = fmt::format("{:.1f} Hz, interval p50 {:.2f} and p99 {:.2f} ms, {} missing, {} rejected",
                          watched.rate, 1e3 * intervals.percentile(0.5), 1e3 * intervals.percentile(0.99),
                          watched.counters.missing, watched.counters.rejected);
  if (watched.isLost) return {"reports", Result::Failed, note};
  if (period <= 0.0) {
    step.text += watched.counters.poses == 0 ? " (it sends only while it is pushed)" : "";
    return step;
  }
  step.text += fmt::format("; its nominal rate is {:.1f} Hz", 1.0 / period);
  const bool isTooSlow = watched.rate < kMinRate / period;
  if (isTooSlow || watched.counters.rejected > watched.counters.poses) step.result = Result::Failed;
  return step;
}

TestStep judgePoses(const Watched& watched) {
  if (!watched.isFinite) return {"poses", Result::Failed, "a pose is not finite"};
  const bool isTooFast = !(watched.mostSpeed <= SafetyLimits{}.faultSpeed);
  return {
      "poses", isTooFast ? Result::Failed : Result::Passed,
      fmt::format("finite, max {:.3f} m/s{}", watched.mostSpeed, isTooFast ? ": faster than any hand" : "")};
}

/// Returns why a push is given up; empty if it goes on.
std::string motionTrouble(const HapticDevice& device, double way, double speed) {
  if (InterruptGuard::isInterrupted()) return "interrupted";
  if (device.state() != DeviceState::Armed) {
    const std::string note = device.stateNote();
    return note.empty() ? "it is no longer armed" : note;
  }
  if (!(way <= kMaxWay)) return fmt::format("the handle moved {:.3f} m: hold it", way);
  if (!(speed <= kMaxSpeed)) return fmt::format("the handle ran away at {:.2f} m/s", speed);
  return {};
}

/// Watches the device without touching it: one step for rate and jitter, one for poses.
std::vector<TestStep> watchReports(TickedDevice& ticked) {
  const Watched watched = watchTicks(ticked);
  const HapticDevice& device = ticked.device();
  return {judgeRate(ticked, watched, device.info().reportPeriod, device.stateNote()), judgePoses(watched)};
}

/// Pushes along a unit axis in the device's frame, rising to `force` [N] and falling smoothly. Gives up at
/// once if the handle runs away or the device stops. The device must be armed.
TestStep push(TickedDevice& ticked, const std::string& name, const glm::dvec3& axis, double force) {
  const glm::dvec3 from = ticked.handle().pose.translation;
  SpeedMeter speed;
  double mostWay = 0.0;
  std::uint64_t ticks = 0, held = 0;
  const Nanoseconds begin = monotonicNow();
  for (double time = 0.0; time < kPushSeconds; time = toSeconds(monotonicNow() - begin)) {
    const double share = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * time / kPushSeconds);
    if (!ticked.tick(Wrench{share * force * axis, glm::dvec3(0.0)}))
      return {name, Result::Failed, ticked.device().stateNote()};
    const glm::dvec3& position = ticked.handle().pose.translation;
    const double way = glm::length(position - from);
    const std::string trouble = motionTrouble(ticked.device(), way, speed.see(position, monotonicNow()));
    if (!trouble.empty()) {
      ticked.tick();
      return {name, Result::Failed, trouble};
    }
    mostWay = std::max(mostWay, way);
    ++ticks;
    held += ticked.handle().isArmed ? 1 : 0;
  }
  ticked.tick();
  if (2 * held < ticks) return {name, Result::Failed, "it exerted no force: hold its dead-man's switch"};
  return {name, Result::Passed,
          fmt::format("up to {:.2f} N, the handle moved up to {:.4f} m", force, mostWay)};
}

/// Time for a device to find its handle's place while somebody moves it [s].
constexpr double kCalibrationSeconds = 20.0;

class Steps {
 public:
  explicit Steps(bool isJson) : isJson_(isJson) {}

  void add(TestStep step) {
    if (!isJson_) {
      print(fmt::format("{}  {:<10}  {}\n", resultName(step.result), step.name, oneLine(step.text)));
      flushOutput();
    }
    steps_.push_back(std::move(step));
  }
  std::size_t failed() const {
    return static_cast<std::size_t>(std::count_if(
        steps_.begin(), steps_.end(), [](const TestStep& each) { return each.result == Result::Failed; }));
  }
  void printJson(const std::string& device) const {
    if (!isJson_) return;
    nlohmann::ordered_json json{
        {"device", device}, {"passed", failed() == 0}, {"steps", nlohmann::ordered_json::array()}};
    for (const TestStep& each : steps_) {
      json["steps"].push_back(
          {{"name", each.name}, {"result", resultName(each.result)}, {"text", each.text}});
    }
    print(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  }
  std::size_t count() const { return steps_.size(); }
  const std::vector<TestStep>& all() const { return steps_; }

 private:
  bool isJson_;
  std::vector<TestStep> steps_;
};

/// Returns the line that the user has typed, if there is one yet.
std::optional<std::string> typedLine() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (::poll(&input, 1, 0) <= 0) return std::nullopt;
  std::array<char, 256> text{};
  const ssize_t count = ::read(STDIN_FILENO, text.data(), text.size());
  std::string line(text.data(), count > 0 ? static_cast<std::size_t>(count) : 0);
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r'))
    line.pop_back();
  return line;
}

/// Ticks the device while it waits, since some devices need that.
bool asksForConsent(TickedDevice& ticked, double force) {
  print(
      fmt::format("Hold the handle. The device will push it with up to {:.2f} N for {} s along each axis.\n"
                  "Type yes to arm the device: ",
                  force, 1));
  flushOutput();
  while (!InterruptGuard::isInterrupted() && ticked.tick()) {
    if (const std::optional<std::string> line = typedLine()) return *line == "yes";
  }
  return false;
}

TestStep waitForCalibration(TickedDevice& ticked, bool isJson) {
  const HapticDevice& device = ticked.device();
  if (!isJson) {
    print(fmt::format("      {}: waiting for {} s\n", oneLine(device.stateNote()), kCalibrationSeconds));
    flushOutput();
  }
  const Nanoseconds begin = monotonicNow();
  while (device.state() == DeviceState::Uncalibrated && !InterruptGuard::isInterrupted() && ticked.tick() &&
         toSeconds(monotonicNow() - begin) < kCalibrationSeconds) {
  }
  const bool isReady = device.state() == DeviceState::Ready;
  return {"calibrate", isReady ? Result::Passed : Result::Failed,
          isReady ? "the position of its handle is known" : device.stateNote()};
}

TestStep armed(HapticDevice& device) {
  try {
    device.arm();
  } catch (const Error& e) {
    return {"arm", Result::Failed, e.what()};
  }
  return {"arm", Result::Passed, "forces are on"};
}

TestStep disarmed(TickedDevice& ticked) {
  ticked.device().disarm();
  const bool isThere = ticked.tick();
  const DeviceState state = ticked.device().state();
  return {"disarm", isThere && state == DeviceState::Ready ? Result::Passed : Result::Failed,
          std::string("it is ") + stateName(state) + (state == DeviceState::Ready ? ", forces are off" : "")};
}

/// True if a user at a terminal can read requests and answer them.
bool canAsk(const DeviceTestOptions& options) {
  return !options.isJson && ::isatty(STDIN_FILENO) == 1 && ::isatty(STDOUT_FILENO) == 1;
}

/// Steps that only a report has, before any force.
void watchForReport(TickedDevice& ticked, Steps& steps, const DeviceTestOptions& options) {
  if (canAsk(options)) {
    print("Take your hands off the handle, or rest it, for a second.\n");
    flushOutput();
  }
  steps.add(measureNoise(ticked));
  if (!canAsk(options)) return steps.add({"axes", Result::Skipped, "nobody is at a terminal to be asked"});
  for (TestStep& step : askForMotions(ticked))
    steps.add(std::move(step));
}

void testForces(TickedDevice& ticked, Steps& steps, const DeviceTestOptions& options) {
  HapticDevice& device = ticked.device();
  const DeviceInfo info = device.info();
  if (info.forceAxes == 0) return steps.add({"forces", Result::Skipped, "this device does not push"});
  const double force = std::min(kTestForce, info.limits.maxForce);
  if (!options.hasConsent && !(canAsk(options) && asksForConsent(ticked, force)))
    return steps.add({"forces", Result::Skipped, "not confirmed: type yes, or give --yes"});
  if (device.state() == DeviceState::Uncalibrated) {
    steps.add(waitForCalibration(ticked, options.isJson));
    if (steps.failed() > 0) return;
  }
  steps.add(armed(device));
  if (steps.failed() > 0) return;
  for (const double first : kFirstForces) {
    if (options.report.empty() || steps.failed() > 0) break;
    steps.add(push(ticked, fmt::format("push {:.1f} N", first), {0.0, 0.0, 1.0}, std::min(first, force)));
  }
  const std::array<std::pair<const char*, glm::dvec3>, 3> pushes = {
      {{"push x", {1.0, 0.0, 0.0}}, {"push y", {0.0, 1.0, 0.0}}, {"push z", {0.0, 0.0, 1.0}}}};
  for (const auto& [name, axis] : pushes) {
    if (steps.failed() > 0) break;
    steps.add(push(ticked, name, axis, force));
  }
  steps.add(disarmed(ticked));
}

}  // namespace

void testDevice(HapticDevice& device, const DeviceTestOptions& options) {
  const InterruptGuard guard;
  Steps steps(options.isJson);
  std::string name;
  DeviceInfo info;
  {
    TickedDevice ticked(device, options.isCalibrating);
    info = device.info();
    name = info.name;
    steps.add({"open", Result::Passed, name + ", " + ticked.grant().describe()});
    for (TestStep& step : watchReports(ticked))
      steps.add(std::move(step));
    if (!options.report.empty() && steps.failed() == 0 && !InterruptGuard::isInterrupted())
      watchForReport(ticked, steps, options);
    // No forces on a device whose poses cannot be trusted.
    if (steps.failed() == 0 && !InterruptGuard::isInterrupted()) testForces(ticked, steps, options);
  }
  steps.printJson(name);
  // Written whatever came of it: what failed is what its reader wants to know.
  if (!options.report.empty()) writeDeviceReport(options.report, info, steps.all());
  if (InterruptGuard::isInterrupted()) throw Error("devices --test", "interrupted", "run it again");
  if (steps.failed() > 0) {
    throw Error(name, fmt::format("{} of {} steps failed", steps.failed(), steps.count()),
                "plug it in again, straight into the computer, and repeat the test");
  }
}

}  // namespace nearfit::cli
