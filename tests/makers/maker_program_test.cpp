// nearfit-cli, unchanged, with the plug-ins beside it: what it lists with and without each maker's driver, and a part led
// by each device.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/servo/motion_reader.h"
#include "device/interface/device_supervisor.h"
#include "tests/makers/maker_bench.h"
#include "tests/makers/standin_haply.h"
#include "tests/support/eventually.h"
#include "tests/support/mesh_generators.h"
#include "tests/support/mesh_text.h"
#include "tests/support/places.h"
#include "tests/support/run_process.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::maker_program_test {
namespace {

namespace fs = std::filesystem;
using test::runCli;
using test::ScopedVariable;
using testing::HasSubstr;
using testing::Not;

/// Nobody listens there: it is a port that only root may take, and no service is registered for it.
constexpr const char* kNobodysPort = "1";

/// As a device says that a busy machine kept from its servo for 20 ms: it may, and then has to stop.
bool isLate(const std::string& text) {
  return text.find(faultReason(DeviceFault::Silent)) != std::string::npos;
}

/// True if a step of --test failed for no other reason than that the machine is busy.
bool isLateStep(const nlohmann::json& step) {
  const auto name = step["name"].get<std::string>(), text = step["text"].get<std::string>();
  const bool isSlow = name == "reports" && text.find(" 0 rejected; its nominal rate is") != std::string::npos;
  // Too late for a push to tell why.
  const bool isStopped = name == "disarm" && text == "it is fault";
  return isSlow || isStopped || isLate(text);
}

/// What surrounds the program: which drivers it finds.
class MakerProgram : public testing::Test {
 protected:
  /// @param libraries  Folders of stand-ins, separated by colons.
  void install(const std::string& libraries) { path_.emplace("LD_LIBRARY_PATH", libraries); }
  void setUpTouch() {
    fs::create_directory(folder_.path() / "config");
    std::ofstream(folder_.path() / "config" / "Default Device.config") << "[DEVICE]\n";
  }
  test::ProcessResult run(std::vector<std::string> arguments) {
    const ScopedVariable haply("NEARFIT_HAPLY_PORT",
                               service_ ? std::to_string(service_->port()) : kNobodysPort);
    const ScopedVariable patience("NEARFIT_HAPLY_PATIENCE", test::MakerBench::kServicePatience);
    const ScopedVariable touch("GTDD_HOME", folder_.path().string());
    // Its own folders, whatever the user has.
    const ScopedVariable data("XDG_DATA_HOME", folder_.path().string());
    return runCli(std::move(arguments));
  }
  nlohmann::json listed() {
    const test::ProcessResult result = run({"devices", "--json"});
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }

  test::TemporaryFolder folder_;
  std::optional<ScopedVariable> path_;
  std::unique_ptr<test::HaplyStandin> service_;
};

TEST_F(MakerProgram, SaysInALineWhatToInstallForEachMaker) {
  install("");
  const test::ProcessResult text = run({"devices"});
  EXPECT_EQ(text.exitCode, 0) << text.err;
  EXPECT_EQ(text.err, "") << "a driver that nobody needs is no trouble";
  for (const char* line : {"\nOpenHaptics: for a Touch or PHANTOM, install ",
                           "\nForce Dimension: for a delta, omega or sigma, install ",
                           "\nHaply: for an Inverse3, install Haply Hub"})
    EXPECT_THAT(text.out, HasSubstr(line));
  EXPECT_EQ(listed()["missing_drivers"].size(), 3U);
}

TEST_F(MakerProgram, ListsTheDevicesOfDriversThatAreThere) {
  install(test::builtPath("standins/whole"));
  setUpTouch();
  service_ = std::make_unique<test::HaplyStandin>();
  const nlohmann::json json = listed();
  EXPECT_EQ(json["missing_drivers"].size(), 0U) << json;
  std::string all;
  for (const auto& device : json["devices"])
    all += device["place"].get<std::string>() + (device["usable"].get<bool>() ? " " : "? ");
  for (const char* place : {"openhaptics:1 ", "forcedimension:1 ", "haply:1 "})
    EXPECT_THAT(all, HasSubstr(place));
}

TEST_F(MakerProgram, NamesTheFunctionThatAnOldDriverLacks) {
  install(test::builtPath("standins/old"));
  setUpTouch();
  const test::ProcessResult text = run({"devices"});
  EXPECT_THAT(text.out, HasSubstr("\nOpenHaptics: libHD.so lacks hdUnschedule"));
  EXPECT_THAT(text.out, HasSubstr("\nForce Dimension: libdhd.so lacks dhdGetButtonMask"));
}

TEST_F(MakerProgram, DoesWithoutFunctionsThatADriverMayLack) {
  install(test::builtPath("standins/spare"));
  // A sigma.7, whose gripper this version of the SDK cannot read, nor say which version it is.
  const ScopedVariable sigma("NEARFIT_STANDIN_MODEL", "104");
  const test::ProcessResult shown =
      run({"devices", "--monitor", "forcedimension:1", "--json", "--seconds", "0.6"});
  ASSERT_NE(shown.out, "") << shown.err;
  const auto last = nlohmann::json::parse(shown.out.substr(0, shown.out.find('\n')));
  EXPECT_TRUE(last["grip"].is_null()) << last;
  const fs::path file = folder_.path() / "report.json";
  run({"devices", "--test", "forcedimension:1", "--json", "--report", file.string()});
  const auto name = nlohmann::json::parse(std::ifstream(file))["device"].get<std::string>();
  EXPECT_THAT(name, testing::StartsWith("sigma.7"));
  EXPECT_THAT(name, Not(HasSubstr("SDK")));
}

/// A maker's device, as a report names it and what it senses and pushes.
struct ReportedDevice {
  std::string libraries;
  const char *place, *name;
  int sensedAxes, forceAxes;
};

TEST_F(MakerProgram, AReportOfEachMakersDeviceIsWhole) {
  setUpTouch();
  service_ = std::make_unique<test::HaplyStandin>();
  // libdhd.so alone: Force Dimension does without the library that calibrates.
  const std::string dhd = test::builtPath("standins/dhd"), whole = test::builtPath("standins/whole");
  for (const ReportedDevice& device :
       {ReportedDevice{dhd, "forcedimension:1", "omega.6, SDK 3.17.1", 6, 3},
        ReportedDevice{whole, "openhaptics:1", "Touch, OpenHaptics 3.50.0, driver 2.7", 6, 3},
        ReportedDevice{whole, "haply:1", "Haply Inverse3 with VerseGrip, firmware 7.4", 6, 3}}) {
    install(device.libraries);
    const fs::path file = folder_.path() / "report.json";
    const test::ProcessResult test = run(
        {"devices", "--test", device.place, "--yes", "--json", "--unjudged-axes", "--report", file.string()});
    const auto report = nlohmann::json::parse(std::ifstream(file));
    EXPECT_EQ(report["format"], "nearfit-device-report");
    EXPECT_THAT(report["device"].get<std::string>(), testing::StartsWith(device.name));
    EXPECT_EQ(report["senses_axes"], device.sensedAxes) << device.place;
    EXPECT_EQ(report["pushes_axes"], device.forceAxes) << device.place;
    std::string steps;
    bool wasLate = false;
    for (const auto& step : report["steps"]) {
      steps += step["name"].get<std::string>() + "=" + step["result"].get<std::string>() + "\n";
      if (step["result"].get<std::string>() != "fail") continue;
      EXPECT_TRUE(isLateStep(step)) << device.place << step;
      wasLate = true;
    }
    EXPECT_THAT(steps, HasSubstr("open=pass")) << device.place;
    EXPECT_EQ(test.exitCode, wasLate ? 1 : 0) << test.out << test.err;
    for (const char* step :
         {"noise=pass", "axes=skip", "push 0.1 N=pass", "push 0.3 N=pass", "push x=pass", "latency="})
      EXPECT_TRUE(wasLate || steps.find(step) != std::string::npos) << device.place << ": " << step << " in\n"
                                                                    << steps;
    for (const char* serial : {"54321", "31415"})
      EXPECT_THAT(report.dump(), Not(HasSubstr(serial))) << "its serial number is nobody's business";
    fs::remove(file);
  }
}

TEST_F(MakerProgram, EachDeviceLeadsAPart) {
  install(test::builtPath("standins/whole"));
  setUpTouch();
  service_ = std::make_unique<test::HaplyStandin>();
  const std::string demo = (test::sourceFolder() / "resources/demo/piston.nearfit").string();
  for (const char* device : {"openhaptics:1", "forcedimension:1", "haply:1"}) {
    const test::ProcessResult result =
        run({"place", demo, "--part", "piston head", "--device", device, "--arm", "--seconds", "0.5"});
    EXPECT_TRUE(result.exitCode == 0 || isLate(result.err)) << device << "\n" << result.out << result.err;
    EXPECT_THAT(result.out, HasSubstr("round trip")) << device;
  }
}

/// A peg over a floor, and what a hand feels that leads it down by a maker's device.
class MakerProgramInContact : public MakerProgram {
 protected:
  static constexpr double kPegGap = 0.002;         ///< Between them at first [m].
  static constexpr const char* kSinking = "0.02";  ///< The hand's, in the device's own time [m/s].

  MakerProgramInContact() {
    install(test::builtPath("standins/whole"));
    setUpTouch();
    folder_.write("peg.obj", test::objText(test::boxMesh({0.04, 0.04, 0.1}, {0.0, 0.0, 0.05 + kPegGap})));
    folder_.write("floor.obj", test::objText(test::boxMesh({0.4, 0.4, 0.1}, {0.0, 0.0, -0.05})));
    const test::ProcessResult made =
        runCli({"scene", "new", scene(), "--unit", "m", "--part", "Floor=" + pathOf("floor.obj"), "--part",
                "Peg=" + pathOf("peg.obj"), "--moving", "Peg"});
    EXPECT_EQ(made.exitCode, 0) << made.err;
  }
  std::string pathOf(const char* name) const { return (folder_.path() / name).string(); }
  std::string scene() const { return pathOf("fit.nearfit"); }
  test::ProcessResult place(const char* device, const char* seconds) {
    return run({"place", scene(), "--part", "Peg", "--device", device, "--arm", "--seconds", seconds,
                "--record", pathOf("felt.csv")});
  }
  /// Presses the peg on the floor for some seconds. Returns true if it was felt; a busy machine stops a device, or leaves it
  /// too little of its own time.
  bool isFelt(const char* device) {
    const ScopedVariable sinking("NEARFIT_STANDIN_SINKING", kSinking);
    service_ = std::make_unique<test::HaplyStandin>();
    fs::remove(pathOf("felt.csv"));
    const test::ProcessResult result = place(device, "2");
    EXPECT_TRUE(result.exitCode == 0 || isLate(result.err)) << device << "\n" << result.out << result.err;
    if (!fs::exists(pathOf("felt.csv"))) return false;
    bool wasFelt = false;
    double lowest = 0.0;
    for (const MotionRow& row : readMotion(pathOf("felt.csv"))) {
      lowest = std::min(lowest, row.proxy.translation.z);
      // Sent to the motors: without arming it is zero.
      wasFelt = wasFelt || (row.contacts > 0 && row.wrench.force.z > kFeltForce);
    }
    EXPECT_GE(lowest, -kPegGap - kRounding) << device << ": the peg is in the floor";
    return wasFelt;
  }

  static constexpr double kFeltForce = 0.5;  ///< More than the friction of the device [N].
  /// Of turning a handle's pose into the part's [m].
  static constexpr double kRounding = 1e-9;
};

TEST_F(MakerProgramInContact, EachDeviceFeelsTheFloor) {
  for (const char* device : {"openhaptics:1", "forcedimension:1", "haply:1"})
    EXPECT_TRUE(test::eventually([&] { return isFelt(device); })) << device;
}

TEST_F(MakerProgramInContact, ADeviceThatIsUnpluggedEndsTheRunAndIsBackOncePluggedInAgain) {
  service_ = std::make_unique<test::HaplyStandin>();
  test::StandinDevice& device = service_->devices().devices[0];
  // Long enough: being unplugged ends it.
  std::future<test::ProcessResult> ran =
      std::async(std::launch::async, [this] { return place("haply:1", "60"); });
  // A busy machine may end it before.
  EXPECT_TRUE(test::eventually([&] {
    return device.exchanges > 500 || ran.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }));
  device.isPlugged = false;
  const test::ProcessResult ended = ran.get();
  EXPECT_NE(ended.exitCode, 0) << ended.out;
  EXPECT_NE(ended.err, "");
  const auto isListed = [this] { return listed()["devices"].dump().find("haply:1") != std::string::npos; };
  EXPECT_FALSE(isListed());
  device.isPlugged = true;
  EXPECT_TRUE(isListed());
  const test::ProcessResult again = place("haply:1", "0.5");
  EXPECT_TRUE(again.exitCode == 0 || isLate(again.err)) << again.out << again.err;
}

TEST_F(MakerProgram, ARecordingHasTheGripOfADeviceWithAGripper) {
  install(test::builtPath("standins/whole"));
  const std::string demo = (test::sourceFolder() / "resources/demo/piston.nearfit").string();
  const std::optional<double> resting = test::StandinDevice::kRestingGrip;
  for (const auto& [model, grip] : {std::pair{"104", resting}, std::pair{"34", std::optional<double>()}}) {
    const fs::path file = folder_.path() / (std::string(model) + ".csv");
    const ScopedVariable chosen("NEARFIT_STANDIN_MODEL", model);
    const test::ProcessResult result =
        run({"place", demo, "--part", "piston head", "--device", "forcedimension:1", "--seconds", "0.5",
             "--record", file.string()});
    EXPECT_TRUE(result.exitCode == 0 || isLate(result.err)) << model << "\n" << result.out << result.err;
    EXPECT_EQ(readMotion(file).back().grip, grip) << model;
    const test::ProcessResult shown =
        run({"devices", "--monitor", "forcedimension:1", "--json", "--seconds", "0.6"});
    const auto last = nlohmann::json::parse(shown.out.substr(0, shown.out.find('\n')));
    EXPECT_EQ(last["grip"], grip ? nlohmann::json(*grip) : nlohmann::json()) << last;
  }
}

}  // namespace
}  // namespace nearfit::maker_program_test
