#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/cli/arguments.h"
#include "app/cli/commands.h"
#include "app/cli/device_monitor.h"
#include "app/cli/device_options.h"
#include "app/cli/device_test.h"
#include "app/cli/devices_text.h"
#include "app/cli/interrupt.h"
#include "app/cli/output.h"
#include "app/cli/rate_options.h"
#include "core/base/error.h"
#include "device/usb/usb_access.h"

namespace nearfit::cli {
namespace {

constexpr const char* kDevicesFooter =
    R"(DEVICE is a driver (openhap, spacemouse, falcon, polhem, plugin), an id (046d:c626), a place (1-4.2), a node of
/dev or a part of the name; default: the first usable device.
--test opens the device and watches its reports and poses for 2 s. Then, only if you type yes or give --yes, it
arms the device and pushes with at most 0.5 N for a second along each axis, with motors for torque also with at most
0.05 N m about each, while you hold the handle.
--report OUT.json with it also measures the noise at rest, asks for a motion along and about each axis, begins at 0.1 N
and measures the latency. Forces follow only if each axis passed; where nobody is at a terminal they are left out, unless
you give --unjudged-axes too. The file says what was found, and holds no serial number.
--monitor --arm arms it as soon as it is ready; it then damps motion with 2 N s/m, at most 0.5 N, none above 0.6 m/s.
Otherwise no device is armed, and none pushes.
Exit code: 0 even if nothing is plugged in; 1 if the chosen device is missing, is lost or fails the test.)";

constexpr std::chrono::milliseconds kLook{100};
/// Covers systems that do not announce changes, and devices of plug-ins.
constexpr int kLooksBetweenLists = 10;

struct DevicesOptions {
  bool isJson = false, printsRules = false, watches = false, hasConsent = false, isCalibrating = false,
       isArming = false, allowsUnjudgedAxes = false;
  std::string monitored, tested, report;
  CLI::Option *monitor = nullptr, *test = nullptr;
  std::optional<double> seconds;
  DeviceFiles files;
  RateOptions rate;
};

void printRules() {
  const std::string file = udevRulesFile();
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in || text.empty()) throw FileError(file, "it cannot be read", "install Nearfit again");
  print(text);
}

/// Returns the devices in `from` that are not in `other`.
std::vector<DeviceListing> without(const std::vector<DeviceListing>& from,
                                   const std::vector<DeviceListing>& other) {
  std::vector<DeviceListing> rest;
  std::copy_if(from.begin(), from.end(), std::back_inserter(rest), [&](const DeviceListing& each) {
    return std::none_of(other.begin(), other.end(),
                        [&](const DeviceListing& known) { return each.isSamePlugging(known); });
  });
  return rest;
}

void printChanges(const std::vector<DeviceListing>& devices, bool hasCome, bool isJson) {
  for (const DeviceListing& each : devices)
    print(isJson ? arrivalJson(each, hasCome) : arrivalText(each, hasCome));
}

void watch(const DevicesOptions& options) {
  const InterruptGuard guard;
  const UsbBus bus;
  const PluginSearch plugins = loadPlugins(pluginFolders());
  const auto begin = std::chrono::steady_clock::now();
  std::vector<DeviceListing> known;
  std::vector<std::string> problems;
  while (!InterruptGuard::isInterrupted()) {
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
    if (options.seconds && time.count() >= *options.seconds) return;
    const std::uint64_t changes = bus.changes();  // Before the list: what comes meanwhile is listed again.
    std::vector<DeviceListing> devices = listDevices(bus, plugins, problems);
    printChanges(without(known, devices), false, options.isJson);
    printChanges(without(devices, known), true, options.isJson);
    flushOutput();
    known = std::move(devices);
    for (int look = 0; look < kLooksBetweenLists && bus.changes() == changes; ++look) {
      if (InterruptGuard::isInterrupted()) return;
      std::this_thread::sleep_for(kLook);
    }
  }
}

void runDevices(const DevicesOptions& options) {
  if (options.seconds) checkPositive("--seconds", *options.seconds);
  if (options.seconds && !options.watches && options.monitor->empty())
    throw UsageError("--seconds", "it is for --watch and --monitor", "leave it out");
  if (options.hasConsent && options.test->empty())
    throw UsageError("--yes", "it is for --test", "leave it out");
  if (!options.report.empty() && options.test->empty())
    throw UsageError("--report", "it is for --test", "leave it out");
  if (options.allowsUnjudgedAxes && options.report.empty())
    throw UsageError("--unjudged-axes", "it is for --test with --report", "leave it out");
  if (options.isArming && options.monitor->empty())
    throw UsageError("--arm", "it is for --monitor", "leave it out");
  if (options.rate.isGiven() && options.monitor->empty() && options.test->empty())
    throw UsageError("options of space mice", "they are for --monitor and --test", "leave them out");
  if (options.isCalibrating && options.monitor->empty() && options.test->empty())
    throw UsageError("--calibrate", "it is for --monitor and --test", "leave it out");
  if (options.printsRules) return printRules();
  if (options.watches) return watch(options);
  if (!options.monitor->empty()) {
    const std::unique_ptr<HapticDevice> device = deviceMeant(options.monitored, options.files);
    applyRateOptions(options.rate, *device);
    return monitorDevice(*device, {options.seconds, options.isJson, options.isCalibrating, options.isArming});
  }
  if (!options.test->empty()) {
    const std::unique_ptr<HapticDevice> device = deviceMeant(options.tested, options.files);
    applyRateOptions(options.rate, *device);
    return testDevice(*device, {options.hasConsent, options.isJson, options.isCalibrating, options.report,
                                options.allowsUnjudgedAxes});
  }
  const PluginSearch plugins = loadPlugins(pluginFolders());
  std::vector<MissingDriver> missing;
  const std::vector<DeviceListing> devices = devicesPluggedIn(plugins, &missing);
  print(options.isJson ? devicesJson(devices, missing) : devicesText(devices, missing));
}

}  // namespace

void addDevicesCommand(CLI::App& program) {
  const auto options = std::make_shared<DevicesOptions>();
  CLI::App* command = program.add_subcommand(
      "devices",
      "Lists the devices that are plugged in and whether they can be used; monitors or tests one.");
  CLI::Option* rules =
      command->add_flag("--udev-rules", options->printsRules, "Print the udev rules that give permission");
  CLI::Option* watched = command->add_flag("--watch", options->watches,
                                           "Report devices as they are plugged in and out, until Ctrl+C");
  options->monitor =
      command->add_option("--monitor", options->monitored,
                          "Show pose, rate, jitter, buttons, grip, force and state until Ctrl+C");
  options->test = command->add_option("--test", options->tested, "Test a device, step by step");
  for (CLI::Option* option : {options->monitor, options->test})
    option->type_name("[DEVICE]")->expected(0, 1);
  rules->excludes(watched)->excludes(options->monitor)->excludes(options->test);
  watched->excludes(options->monitor)->excludes(options->test);
  options->monitor->excludes(options->test);
  command->add_option("--seconds", options->seconds, "End --watch or --monitor after this time [s]")
      ->type_name("S");
  command->add_flag("--yes", options->hasConsent,
                    "Confirm the forces of --test: somebody must hold the handle");
  command
      ->add_option("--report", options->report,
                   "With --test: test more, step by step, and write what was found, to send in")
      ->type_name("FILE");
  command->add_flag("--unjudged-axes", options->allowsUnjudgedAxes,
                    "With --report: push even if nobody is at a terminal to say which way each axis goes");
  command->add_flag("--arm", options->isArming,
                    "With --monitor: resist motion weakly, at most 0.5 N; hold the handle");
  command->add_flag("--calibrate", options->isCalibrating, kCalibrateHelp);
  command->add_flag("--json", options->isJson, "Print JSON, one object per line");
  addDeviceFileOptions(*command, options->files);
  addRateOptions(*command, options->rate);
  command->footer(kDevicesFooter);
  command->callback([options] { runDevices(*options); });
}

}  // namespace nearfit::cli
