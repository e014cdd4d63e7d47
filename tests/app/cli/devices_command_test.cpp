#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/app/cli/place_fixture.h"
#include "tests/support/places.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::test::devices_command_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::StartsWith;

/// A device that nobody has: tests run on machines with devices too.
constexpr const char* kNobodys = "ffff:0000";

TEST(DevicesCommand, ListsWhatThereIsAndHandsThatNeedNoDevice) {
  const ProcessResult text = runCli({"devices"});
  EXPECT_EQ(text.exitCode, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("Simulated hand on a path: nearfit-cli place --path FILE\n"),
                              HasSubstr("Mouse, numbers and arrow keys")));
  const ProcessResult result = runCli({"devices", "--json"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(linesOf(result.out).size(), 1U);
  const auto json = nlohmann::json::parse(result.out);
  std::vector<std::string> hands;
  for (const auto& hand : json["simulated"])
    hands.push_back(hand["id"]);
  EXPECT_THAT(hands, IsSupersetOf({"path", "scripted", "manual"}));
  for (const auto& device : json["devices"]) {
    EXPECT_EQ(device["usable"].get<bool>(), device["problem"].is_null()) << device;
    EXPECT_EQ(device["usable"].get<bool>(), device["reason"].get<std::string>().empty()) << device;
  }
}

TEST(DevicesCommand, TheUdevRulesArePrintedAsTheyAreInstalled) {
  const ProcessResult result = runCli({"devices", "--udev-rules"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.out, readBytes(test::sourceFolder() / "resources/udev/70-nearfit.rules"));
}

TEST(DevicesCommand, WatchingEndsWhenItsTimeIsUp) {
  const ProcessResult result = runCli({"devices", "--watch", "--seconds", "0.2", "--json"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  for (const std::string& line : linesOf(result.out))
    EXPECT_EQ(nlohmann::json::parse(line)["event"], "arrived");
}

TEST(DevicesCommand, AFolderOfPlugInsThatOthersMayWriteToIsRefusedWithAWord) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  const fs::path plugin = folder.path() / "driver.so";
  std::ofstream(plugin) << "never loaded";
  fs::permissions(plugin, fs::perms::owner_all);
  fs::permissions(folder.path(), fs::perms::owner_all | fs::perms::group_write);
  const ScopedVariable named("NEARFIT_PLUGINS", folder.path().string());
  const ProcessResult result = runCli({"devices"});
  EXPECT_THAT(result.err, AllOf(HasSubstr("warning: "), HasSubstr("driver.so"),
                                HasSubstr("other users can write to its folder"),
                                HasSubstr("run: chmod go-w " + folder.path().string())));
}

TEST(DevicesCommand, ADeviceThatIsNotThereIsSaidInOneLine) {
  for (const std::string option : {"--monitor", "--test"}) {
    const ProcessResult result = runCli({"devices", option, kNobodys});
    EXPECT_EQ(result.exitCode, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.err, AllOf(StartsWith("nearfit-cli: "), HasSubstr("plugged in")));
  }
}

TEST(DevicesCommand, OptionsThatDoNotGoTogetherAreRefused) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{"--monitor", "--watch"}, "--watch excludes --monitor"},
      {{"--test", kNobodys, "--monitor", kNobodys}, "excludes"},
      {{"--seconds", "1"}, "--seconds: it is for --watch and --monitor"},
      {{"--watch", "--seconds", "0"}, "--seconds: 0 is out of range"},
      {{"--calibrate"}, "--calibrate: it is for --monitor and --test"},
      {{"--yes"}, "--yes: it is for --test"},
      {{"--test", kNobodys, "--unjudged-axes"}, "--unjudged-axes: it is for --test with --report"},
      {{"something"}, "something"},
  };
  for (const auto& [options, problem] : wrong) {
    std::vector<std::string> arguments = options;
    arguments.insert(arguments.begin(), "devices");
    const ProcessResult result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 2) << problem;
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.err, HasSubstr(problem));
  }
}

using PlaceWithDevice = PlaceFixture;

TEST_F(PlaceWithDevice, APathOrADeviceLeadsAndNotBoth) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong = {
      {{}, "nothing moves the part"},
      {{"--path", "path.csv", "--device", kNobodys}, "--path and --device are both given"},
      {{"--device", kNobodys, "--fast"}, "--fast: a device sets its own pace"},
      {{"--path", "path.csv", "--arm"}, "--arm: it is for --device"},
      {{"--path", "path.csv", "--seconds", "1"}, "--seconds: it is for --device"},
      {{"--device", kNobodys, "--seconds", "-1"}, "--seconds: -1 is out of range"},
  };
  for (const auto& [options, problem] : wrong) {
    std::vector<std::string> arguments = options;
    arguments.insert(arguments.begin(), {"--part", "Cone"});
    const ProcessResult result = place(arguments);
    EXPECT_EQ(result.exitCode, 2) << problem << result.err;
    EXPECT_EQ(linesOf(result.err).size(), 1U) << result.err;
    EXPECT_THAT(result.err, HasSubstr(problem));
  }
}

TEST_F(PlaceWithDevice, ADeviceThatIsNotThereLeavesNoFiles) {
  const ProcessResult result =
      place({"--part", "Cone", "--device", kNobodys, "--record", "felt.csv", "--export", "end.json"});
  EXPECT_EQ(result.exitCode, 1);
  EXPECT_THAT(result.err, HasSubstr("plugged in"));
  EXPECT_FALSE(std::filesystem::exists(file("felt.csv")));
  EXPECT_FALSE(std::filesystem::exists(file("end.json")));
}

}  // namespace
}  // namespace nearfit::test::devices_command_test
