#include "app/cli/device_test.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <unistd.h>

#include "app/cli/device_monitor.h"
#include "app/cli/device_test_steps.h"
#include "app/cli/interrupt.h"
#include "app/cli/output.h"
#include "core/base/error.h"

namespace nearfit::cli {
namespace {

using Result = TestStep::Result;

/// Time for a device to find its handle's place while somebody moves it [s].
constexpr double kCalibrationSeconds = 20.0;

const char* resultName(Result result) {
  switch (result) {
    case Result::Passed:
      return "pass";
    case Result::Failed:
      return "fail";
    case Result::Skipped:
      return "skip";
  }
  return "";
}

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

void testForces(TickedDevice& ticked, Steps& steps, const DeviceTestOptions& options) {
  HapticDevice& device = ticked.device();
  const DeviceInfo info = device.info();
  if (info.forceAxes == 0) return steps.add({"forces", Result::Skipped, "this device does not push"});
  const double force = std::min(kTestForce, info.limits.maxForce);
  const bool canAsk = !options.isJson && ::isatty(STDIN_FILENO) == 1 && ::isatty(STDOUT_FILENO) == 1;
  if (!options.hasConsent && !(canAsk && asksForConsent(ticked, force)))
    return steps.add({"forces", Result::Skipped, "not confirmed: type yes, or give --yes"});
  if (device.state() == DeviceState::Uncalibrated) {
    steps.add(waitForCalibration(ticked, options.isJson));
    if (steps.failed() > 0) return;
  }
  steps.add(armed(device));
  if (steps.failed() > 0) return;
  const std::array<std::pair<const char*, glm::dvec3>, 3> pushes = {
      {{"push x", {1.0, 0.0, 0.0}}, {"push y", {0.0, 1.0, 0.0}}, {"push z", {0.0, 0.0, 1.0}}}};
  for (const auto& [name, axis] : pushes) {
    steps.add(push(ticked, name, axis, force));
    if (steps.failed() > 0) break;
  }
  steps.add(disarmed(ticked));
}

}  // namespace

void testDevice(HapticDevice& device, const DeviceTestOptions& options) {
  const InterruptGuard guard;
  Steps steps(options.isJson);
  std::string name;
  {
    TickedDevice ticked(device, options.isCalibrating);
    name = device.info().name;
    steps.add({"open", Result::Passed, name + ", " + ticked.grant().describe()});
    for (TestStep& step : watchReports(ticked))
      steps.add(std::move(step));
    // No forces on a device whose poses cannot be trusted.
    if (steps.failed() == 0 && !InterruptGuard::isInterrupted()) testForces(ticked, steps, options);
  }
  steps.printJson(name);
  if (InterruptGuard::isInterrupted()) throw Error("devices --test", "interrupted", "run it again");
  if (steps.failed() > 0) {
    throw Error(name, fmt::format("{} of {} steps failed", steps.failed(), steps.count()),
                "plug it in again, straight into the computer, and repeat the test");
  }
}

}  // namespace nearfit::cli
