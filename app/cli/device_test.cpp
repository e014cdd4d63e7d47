#include "app/cli/device_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
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
#include "app/cli/device_push.h"
#include "app/cli/device_report.h"
#include "app/cli/interrupt.h"
#include "app/cli/output.h"
#include "app/cli/ticked_device.h"
#include "core/base/error.h"
#include "device/interface/device_supervisor.h"

namespace nearfit::cli {
namespace {

using Result = TestStep::Result;

constexpr double kWatchSeconds = 2.0;
/// The servo copes with half the nominal rate, with softer contact; less means a bad cable or hub.
constexpr double kMinRate = 0.5;

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

/// Watches the device without touching it: one step for rate and jitter, one for poses.
std::vector<TestStep> watchReports(TickedDevice& ticked) {
  const Watched watched = watchTicks(ticked);
  const HapticDevice& device = ticked.device();
  return {judgeRate(ticked, watched, device.info().reportPeriod, device.stateNote()), judgePoses(watched)};
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
bool asksForConsent(TickedDevice& ticked, const DeviceInfo& info) {
  const double torque = testTorqueOf(info);
  print(fmt::format(
      "Hold the handle. The device will push it with up to {:.2f} N for a second along each axis{}.\n"
      "Type yes to arm the device: ",
      testForceOf(info),
      torque > 0.0 ? fmt::format(", and turn it with up to {:.2f} N m about each", torque) : ""));
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

/// Finds the handle's place first, where it is not known: what is measured before means nothing.
void calibrateFirst(TickedDevice& ticked, Steps& steps, const DeviceTestOptions& options) {
  if (ticked.device().state() == DeviceState::Uncalibrated)
    steps.add(waitForCalibration(ticked, options.isJson));
}

/// The outcome of the steps before any force.
struct BeforeForces {
  double noise = 0.0;    ///< Of the pose at rest, rms [m].
  std::string obstacle;  ///< Why there must be no force; empty if there may be.
};

/// Steps that only a report has, before any force.
BeforeForces watchForReport(TickedDevice& ticked, Steps& steps, const DeviceTestOptions& options) {
  calibrateFirst(ticked, steps, options);
  if (steps.failed() > 0) return {0.0, "its pose is not known"};
  if (canAsk(options)) {
    print("Take your hands off the handle, or rest it, for a second.\n");
    flushOutput();
  }
  const MeasuredNoise noise = measureNoise(ticked);
  steps.add(noise.step);
  if (noise.step.result != Result::Passed) return {noise.rms, "its pose is not at rest"};
  if (!canAsk(options)) {
    steps.add({"axes", Result::Skipped, "nobody is at a terminal to be asked"});
    if (options.allowsUnjudgedAxes) return {noise.rms, ""};
    return {
        noise.rms,
        "the axes were not judged, and on one that is reversed walls would pull: run it at a terminal, or "
        "give --unjudged-axes"};
  }
  BeforeForces before{noise.rms, ""};
  for (TestStep& step : askForMotions(ticked)) {
    if (before.obstacle.empty() && step.result != Result::Passed)
      before.obstacle = step.name + " did not pass";
    steps.add(std::move(step));
  }
  return before;
}

void testForces(TickedDevice& ticked, Steps& steps, const DeviceTestOptions& options,
                const BeforeForces& before) {
  HapticDevice& device = ticked.device();
  const DeviceInfo info = device.info();
  if (info.forceAxes == 0) return steps.add({"forces", Result::Skipped, "this device does not push"});
  if (!before.obstacle.empty()) return steps.add({"forces", Result::Skipped, "left out: " + before.obstacle});
  if (!options.hasConsent && !(canAsk(options) && asksForConsent(ticked, info)))
    return steps.add({"forces", Result::Skipped, "not confirmed: type yes, or give --yes"});
  calibrateFirst(ticked, steps, options);
  if (steps.failed() > 0) return;
  steps.add(armed(device));
  if (steps.failed() > 0) return;
  const bool isForReport = !options.report.empty();
  for (const DevicePush& push : pushesOf(info, isForReport)) {
    if (steps.failed() > 0) break;
    steps.add(pushHandle(ticked, push));
  }
  if (isForReport && steps.failed() == 0) steps.add(measureLatency(ticked, testForceOf(info), before.noise));
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
    BeforeForces before;
    if (!options.report.empty() && steps.failed() == 0 && !InterruptGuard::isInterrupted())
      before = watchForReport(ticked, steps, options);
    // No forces on a device whose poses cannot be trusted.
    if (steps.failed() == 0 && !InterruptGuard::isInterrupted()) testForces(ticked, steps, options, before);
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
