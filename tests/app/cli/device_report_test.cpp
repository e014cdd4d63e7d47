#include "app/cli/device_report.h"

#include <cmath>
#include <cstddef>
#include <fstream>
#include <set>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/cli/device_push.h"
#include "tests/support/run_process.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::device_report_test {
namespace {

using cli::AskedMotion;
using cli::judgeMotion;
using cli::TestStep;
using testing::HasSubstr;

TEST(DeviceReport, AsksForEachAxisThatIsSensed) {
  EXPECT_EQ(cli::askedMotions(3).size(), 3U);
  const auto asked = cli::askedMotions(6);
  ASSERT_EQ(asked.size(), 6U);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    EXPECT_EQ(asked[i].isTurn, i >= 3) << i;
    EXPECT_EQ(std::abs(asked[i].axis[static_cast<int>(i % 3)]), 1.0) << i;
  }
  std::set<std::string> names;
  for (const AskedMotion& each : asked)
    names.insert(each.name);
  EXPECT_EQ(names.size(), asked.size());
}

TEST(DeviceReport, AnAxisThatIsReversedOrExchangedFails) {
  const AskedMotion right = cli::askedMotions(3).front();
  EXPECT_EQ(judgeMotion(right, {0.05, 0.01, -0.01}).result, TestStep::Result::Passed);
  EXPECT_EQ(judgeMotion(right, {-0.05, 0.0, 0.0}).result, TestStep::Result::Failed);
  EXPECT_EQ(judgeMotion(right, {0.01, 0.05, 0.0}).result, TestStep::Result::Failed);
  EXPECT_EQ(judgeMotion(right, {0.005, 0.0, 0.0}).result, TestStep::Result::Skipped);
}

/// Clockwise from above is about -z, by the right hand.
TEST(DeviceReport, ATurnTheOtherWayRoundFails) {
  const AskedMotion clockwise = cli::askedMotions(6).back();
  EXPECT_EQ(judgeMotion(clockwise, {0.0, 0.1, -0.8}).result, TestStep::Result::Passed);
  EXPECT_EQ(judgeMotion(clockwise, {0.0, 0.0, 0.8}).result, TestStep::Result::Failed);
  EXPECT_EQ(judgeMotion(clockwise, {0.0, 0.0, -0.1}).result, TestStep::Result::Skipped);
}

/// "Tip the top towards you": up, z, becomes towards, -y. "To the right": up becomes x.
TEST(DeviceReport, TheAxesOfTurnsFollowTheirWords) {
  const auto asked = cli::askedMotions(6);
  const glm::dvec3 up(0.0, 0.0, 1.0);
  // A small turn about an axis moves a point by their cross product.
  EXPECT_EQ(glm::cross(asked[3].axis, up), glm::dvec3(0.0, -1.0, 0.0)) << asked[3].request;
  EXPECT_EQ(glm::cross(asked[4].axis, up), glm::dvec3(1.0, 0.0, 0.0)) << asked[4].request;
}

TEST(DevicePush, TorquesFollowForcesOnlyWhereThereAreMotorsForThem) {
  DeviceInfo info{"PHANTOM", 6, DeviceLimits{}, 1e-3};
  info.limits.maxForce = 0.25;
  info.limits.maxTorque = 0.02;
  const auto pushes = cli::pushesOf(info, /*isGradual=*/true);
  ASSERT_EQ(pushes.size(), 12U);
  for (std::size_t i = 0; i < pushes.size(); ++i) {
    EXPECT_EQ(pushes[i].isTurn, i >= 6) << pushes[i].name;
    EXPECT_LE(pushes[i].size, pushes[i].isTurn ? 0.02 : 0.25) << pushes[i].name;
    // Small ones first, of each kind.
    EXPECT_GE(pushes[i].size, i % 6 == 0 ? 0.0 : pushes[i - 1].size) << pushes[i].name;
  }
  info.limits.maxTorque = 0.0;
  EXPECT_EQ(cli::pushesOf(info, true).size(), 6U);
  info.forceAxes = 3;
  EXPECT_EQ(cli::pushesOf(info, false).size(), 3U);
  info.forceAxes = 0;
  EXPECT_TRUE(cli::pushesOf(info, true).empty());
}

TEST(DeviceReport, HoldsWhatTheTestFoundInOneFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "report.json";
  DeviceInfo info{"Touch", 3, DeviceLimits{}, 1e-3};
  info.limits.maxForce = 3.3;
  info.limits.maxTorque = 0.2;
  info.limits.damping = 0.6;
  info.limits.rotationalDamping = 2e-3;
  info.limits.leastMass = 0.07;
  info.limits.leastInertia = 6e-5;
  info.maxSpeed = 1.5;
  cli::writeDeviceReport(file, info, {{"axis x", TestStep::Result::Failed, "it moved\nanother way"}});
  std::ifstream in(file);
  const auto json = nlohmann::json::parse(in);
  EXPECT_EQ(json["format"], "nearfit-device-report");
  EXPECT_EQ(json["device"], "Touch");
  EXPECT_DOUBLE_EQ(json["rate_hz"], 1000.0);
  EXPECT_EQ(json["version"], 1);
  // Of the program itself, not of the format: what nearfit-cli --version says.
  const std::string version = test::runCli({"--version"}).out;
  EXPECT_EQ("nearfit-cli " + json["program_version"].get<std::string>() + "\n", version);
  for (const auto& [name, value] :
       {std::pair{"force_n", 3.3}, std::pair{"torque_nm", 0.2}, std::pair{"damping_nspm", 0.6},
        std::pair{"rotational_damping_nms", 2e-3}, std::pair{"mass_kg", 0.07},
        std::pair{"inertia_kgm2", 6e-5}, std::pair{"speed_mps", 1.5}})
    EXPECT_DOUBLE_EQ(json["limits"][name].get<double>(), value) << name;
  EXPECT_EQ(json["steps"].size(), 1U);
  EXPECT_EQ(json["steps"][0]["result"], "fail");
  EXPECT_THAT(json["steps"][0]["text"].get<std::string>(), HasSubstr("another way"));
}

}  // namespace
}  // namespace nearfit::device_report_test
