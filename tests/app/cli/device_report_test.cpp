#include "app/cli/device_report.h"

#include <fstream>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
  ASSERT_EQ(asked.size(), 4U);
  EXPECT_TRUE(asked.back().isTurn);
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

TEST(DeviceReport, HoldsWhatTheTestFoundInOneFile) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "report.json";
  DeviceInfo info{"Touch", 3, DeviceLimits{}, 1e-3};
  info.limits.maxForce = 3.3;
  cli::writeDeviceReport(file, info, {{"axis x", TestStep::Result::Failed, "it moved\nanother way"}});
  std::ifstream in(file);
  const auto json = nlohmann::json::parse(in);
  EXPECT_EQ(json["format"], "nearfit-device-report");
  EXPECT_EQ(json["device"], "Touch");
  EXPECT_DOUBLE_EQ(json["rate_hz"], 1000.0);
  EXPECT_DOUBLE_EQ(json["limits"]["force_n"], 3.3);
  EXPECT_EQ(json["steps"].size(), 1U);
  EXPECT_EQ(json["steps"][0]["result"], "fail");
  EXPECT_THAT(json["steps"][0]["text"].get<std::string>(), HasSubstr("another way"));
}

}  // namespace
}  // namespace nearfit::device_report_test
