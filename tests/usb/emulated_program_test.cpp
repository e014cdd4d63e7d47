#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "device/interface/device_supervisor.h"
#include "tests/app/cli/place_fixture.h"
#include "tests/support/eventually.h"
#include "tests/support/places.h"

namespace nearfit::test::emulated_program_test {
namespace {

using ::testing::HasSubstr;

/// nearfit-cli, unchanged, with a device plugged in that nearfit-emulate makes.
class EmulatedProgram : public PlaceFixture {
 protected:
  ProcessResult run(std::vector<std::string> emulation, const std::vector<std::string>& arguments) const {
    emulation.insert(emulation.begin(), test::builtPath("nearfit-emulate"));
    emulation.insert(emulation.end(), {"--", test::builtPath("nearfit-cli")});
    emulation.insert(emulation.end(), arguments.begin(), arguments.end());
    return runProcess(emulation, options_);
  }
  /// A machine on which a thread does not run for 20 ms stops an armed device, and is right to; one that runs
  /// the device's thread half the time only fails the test of its rate: then, and then only, again.
  ProcessResult runUnstopped(const std::vector<std::string>& emulation,
                             const std::vector<std::string>& arguments) const {
    ProcessResult result;
    eventually([&] {
      result = run(emulation, arguments);
      return result.exitCode == 0 || !(wasStoppedForSilence(result) || wasTooSlow(result));
    });
    return result;
  }
  /// By this side, or by the device, for which no wrench came.
  static bool wasStoppedForSilence(const ProcessResult& result) {
    const std::string told = result.out + result.err;
    return told.find(faultReason(DeviceFault::Silent)) != std::string::npos ||
           told.find(faultReason(DeviceFault::Reported)) != std::string::npos;
  }
  static bool wasTooSlow(const ProcessResult& result) {
    const auto told = nlohmann::json::parse(result.out, nullptr, false);
    if (!told.is_object() || !told.contains("steps")) return false;
    return std::any_of(told["steps"].begin(), told["steps"].end(), [](const nlohmann::json& step) {
      return step["name"] == "reports" && step["result"] == "fail";
    });
  }
  /// The tip over the floor, near enough to be felt wherever the emulated hand goes (4 cm at most).
  void bringNear() const {
    changePart("Cone", [](Part& part) { part.worldFromPart.translation.z = kTip; });
  }

  static constexpr double kTip = 0.05;
};

TEST_F(EmulatedProgram, DevicesAreListedAsUsable) {
  for (const std::string kind : {"openhap", "spacemouse", "polhem", "falcon"}) {
    const ProcessResult result = run({kind}, {"devices", "--json"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const auto devices = nlohmann::json::parse(result.out)["devices"];
    ASSERT_EQ(devices.size(), 1U);
    EXPECT_EQ(devices[0]["driver"], kind);
    EXPECT_TRUE(devices[0]["usable"]);
  }
}

TEST_F(EmulatedProgram, WatchingTellsOfTheDeviceThatLeaves) {
  const ProcessResult result =
      run({"openhap", "--seconds", "0.5"}, {"devices", "--watch", "--seconds", "8", "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  std::vector<std::string> events;
  for (const std::string& line : linesOf(result.out))
    events.push_back(nlohmann::json::parse(line)["event"]);
  EXPECT_EQ(events, (std::vector<std::string>{"arrived", "left"}));
}

TEST_F(EmulatedProgram, MonitoringShowsItMoving) {
  for (const std::string kind : {"openhap", "spacemouse", "polhem", "falcon"}) {
    // An arm is held in its rest at first, for whoever calibrates it.
    std::vector<std::string> arguments{"devices", "--monitor", kind, "--seconds", "2.2", "--json"};
    if (kind == "polhem") arguments.emplace_back("--calibrate");
    const ProcessResult result = run({kind}, arguments);
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const std::vector<std::string> lines = linesOf(result.out);
    ASSERT_GE(lines.size(), 2U);
    const auto first = nlohmann::json::parse(lines.front()), last = nlohmann::json::parse(lines.back());
    EXPECT_GT(last["reports"], first["reports"]) << kind;
    EXPECT_NE(last["pose"], first["pose"]) << kind;
    EXPECT_EQ(last["rejected"], 0) << kind;
    // What pushes nothing is always armed.
    EXPECT_EQ(last["state"], kind == "spacemouse" ? "armed" : "ready") << kind;
  }
}

TEST_F(EmulatedProgram, AFalconIsGivenTheFirmwareThatItTakes) {
  folder_.write("right.bin", std::string(1000, 'f'));
  folder_.write("wrong.bin", std::string(1000, 'g'));
  const auto monitor = [&](const std::string& given) {
    return run({"falcon", "--firmware", file("right.bin").string()},
               {"devices", "--monitor", "falcon", "--seconds", "0.6", "--falcon-firmware", given});
  };
  EXPECT_EQ(monitor("right.bin").exitCode, 0);
  const ProcessResult wrong = monitor("wrong.bin");
  EXPECT_EQ(wrong.exitCode, 1);
  EXPECT_THAT(wrong.err, HasSubstr("it accepted the firmware but does not run it"));
}

TEST_F(EmulatedProgram, ADeviceLeadsThePartWithPosesInAndWrenchesOut) {
  bringNear();
  const ProcessResult result =
      runUnstopped({"openhap"}, {"place", "fit.nearfit", "--part", "Cone", "--device", "openhap", "--arm",
                                 "--seconds", "1", "--record", "felt.csv", "--export", "end.json", "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto device = nlohmann::json::parse(result.out)["device"];
  EXPECT_TRUE(device["armed"]);
  EXPECT_GT(device["reports"], 0);
  EXPECT_EQ(device["rejected"], 0);
  EXPECT_GT(device["round_trips"], 0);
  const auto& times = device["round_trip_us"];
  EXPECT_LE(times["p50"], times["p99"]);
  EXPECT_LE(times["p99"], times["p99.9"]);
  EXPECT_LE(times["p99.9"], times["max"]);
  EXPECT_TRUE(std::filesystem::exists(file("end.json")));
  // Poses in: from where the part was, on a circle that the handle goes round. Wrenches out: the springs'.
  const Record record(file("felt.csv"));
  ASSERT_GT(record.rows(), 10U);
  EXPECT_NEAR(record["handle_tz"][0], kTip, 1e-3);
  double farthest = 0.0, strongest = 0.0;
  for (std::size_t i = 0; i < record.rows(); ++i) {
    farthest = std::max(
        farthest, std::hypot(record["handle_tx"][i] - 0.3, record["handle_tz"][i] - record["handle_tz"][0]));
    strongest = std::max(strongest, record["force_z"][i]);
    EXPECT_LE(record["force_z"][i], 50.0 * (0.1 - (kTip - 0.04)));
  }
  EXPECT_GT(farthest, 0.005);
  EXPECT_LE(farthest, 0.04 + 1e-6);
  EXPECT_GT(strongest, 0.5);
}

TEST_F(EmulatedProgram, WithoutArmingTheDeviceLeadsAndDoesNotPush) {
  bringNear();
  const ProcessResult result = run({"openhap"}, {"place", "fit.nearfit", "--part", "Cone", "--device",
                                                 "--seconds", "1", "--record", "felt.csv"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr(", not armed\n"));
  const Record record(file("felt.csv"));
  for (const double force : record["force_z"])
    ASSERT_EQ(force, 0.0);
}

TEST_F(EmulatedProgram, ASpaceMouseLeadsThePart) {
  const ProcessResult result =
      run({"spacemouse"}, {"place", "fit.nearfit", "--part", "Cone", "--device", "spacemouse", "--seconds",
                           "1.5", "--record", "felt.csv", "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_GT(nlohmann::json::parse(result.out)["device"]["reports"], 0);
  // Its axes go to and fro one after the other, by its own clock: which one this saw depends on the machine.
  const Record record(file("felt.csv"));
  ASSERT_GT(record.rows(), 0U);
  const auto way = [&record](const char* column) {
    const auto& values = record[column];
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return *most - *least;
  };
  EXPECT_GT(std::max({way("handle_tx"), way("handle_ty"), way("handle_tz"), way("handle_qx"),
                      way("handle_qy"), way("handle_qz")}),
            1e-3);
}

TEST_F(EmulatedProgram, APulledPlugEndsItWithAReasonAndWholeFiles) {
  bringNear();
  for (const std::string how : {"eproto", "eshutdown", "nodevice"}) {
    // A busy machine may take the first reports before the servo runs: then it gets more of them.
    std::size_t rows = 0;
    for (const char* reports : {"300", "3000", "30000"}) {
      const ProcessResult result = run({"openhap", "--reports", reports, "--unplug", how},
                                       {"place", "fit.nearfit", "--part", "Cone", "--device", "--seconds",
                                        "120", "--record", how + ".csv", "--export", how + ".json"});
      EXPECT_EQ(result.exitCode, 1) << how;
      EXPECT_THAT(result.err, HasSubstr("the files contain everything up to then")) << how;
      EXPECT_TRUE(std::filesystem::exists(file(how + ".json"))) << how;
      rows = Record(file(how + ".csv")).rows();
      if (rows > 0) break;
    }
    EXPECT_GT(rows, 0U) << how;
  }
}

TEST_F(EmulatedProgram, ATestPassesWithConsent) {
  // A hand that holds still.
  folder_.write("still.csv", "0,0,0,1,0,0,0\n");
  const ProcessResult result =
      runUnstopped({"openhap", "--rate", "200", "--path", file("still.csv").string()},
                   {"devices", "--test", "openhap", "--yes", "--json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_TRUE(nlohmann::json::parse(result.out)["passed"]);
}

}  // namespace
}  // namespace nearfit::test::emulated_program_test
