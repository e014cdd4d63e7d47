#include "device/plugin/device_plugin.h"

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "tests/support/places.h"
#include "tests/support/scoped_variable.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::device_plugin_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kExamplePlugin = test::builtPath("test_plugins/libnearfit_example_plugin.so");

std::string whyNot(const fs::path& file) {
  try {
    DevicePlugin::load(file);
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "";
}

TEST(DevicePlugin, ExampleIsLoadedOpenedReadAndPushed) {
  const auto plugin = DevicePlugin::load(kExamplePlugin);
  EXPECT_EQ(plugin->name(), "Example plug-in");
  const auto devices = plugin->devices();
  ASSERT_EQ(devices.size(), 1U);
  const std::unique_ptr<HapticDevice> device = makePluginDevice(plugin, 0, devices[0]);
  EXPECT_EQ(device->info().forceAxes, 3);
  EXPECT_EQ(device->info().sensedAxes, 6);
  EXPECT_TRUE(device->info().isTurningUnfelt());
  EXPECT_EQ(device->info().limits.maxForce, 5.0);
  device->start({});
  EXPECT_EQ(device->state(), DeviceState::Ready);
  HandleInput handle;
  ASSERT_TRUE(device->readHandle(handle));
  EXPECT_FALSE(handle.isArmed);
  EXPECT_TRUE(handle.hasOwnFrame);
  EXPECT_NEAR(glm::length(glm::dvec2(handle.pose.translation)), 0.01, 1e-12);
  const Wrench push{{0.0, 0.0, 3.0}, {}};
  device->sendWrench(push);
  ASSERT_TRUE(device->readHandle(handle));
  EXPECT_EQ(handle.pose.translation.z, 0.0) << "not armed: nothing goes out";
  device->arm();
  ASSERT_TRUE(device->readHandle(handle));
  EXPECT_TRUE(handle.isArmed);
  device->sendWrench(push);
  ASSERT_TRUE(device->readHandle(handle));
  EXPECT_NEAR(handle.pose.translation.z, 3e-3, 1e-15);
  device->stop();
  EXPECT_EQ(device->state(), DeviceState::Present);
  EXPECT_FALSE(device->readHandle(handle));
}

TEST(DevicePlugin, ItsOwnWordsReachTheUser) {
  const auto plugin = DevicePlugin::load(kExamplePlugin);
  const test::ScopedVariable fails("NEARFIT_EXAMPLE_FAILS", "1");
  try {
    plugin->devices();
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the maker's service does not run"));
  }
}

TEST(DevicePlugin, WhatIsNoneIsRefusedWithItsReason) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(whyNot(folder.path() / "none.so"), HasSubstr("No such file"));
  const fs::path text = folder.path() / "text.so";
  std::ofstream(text) << "not a library";
  fs::permissions(text, fs::perms::owner_all);
  EXPECT_THAT(whyNot(text), HasSubstr("cannot be loaded"));
  EXPECT_THAT(whyNot(folder.path()), HasSubstr("not a file"));
}

TEST(DevicePlugin, FilesThatOthersMayWriteAreNotLoaded) {
  const test::TemporaryFolder folder;
  const fs::path copy = folder.path() / "copy.so";
  fs::copy_file(kExamplePlugin, copy);
  fs::permissions(copy, fs::perms::owner_all | fs::perms::others_write);
  EXPECT_THAT(whyNot(copy), HasSubstr("other users can write"));
  fs::permissions(copy, fs::perms::owner_all);
  EXPECT_EQ(whyNot(copy), "");
}

TEST(DevicePlugin, FilesInFoldersThatOthersMayWriteAreNotLoaded) {
  const test::TemporaryFolder folder;
  const fs::path copy = folder.path() / "copy.so";
  fs::copy_file(kExamplePlugin, copy);
  fs::permissions(copy, fs::perms::owner_all);
  fs::permissions(folder.path(), fs::perms::owner_all | fs::perms::group_write);
  EXPECT_THAT(whyNot(copy), HasSubstr("other users can write to its folder"));
  fs::permissions(folder.path(), fs::perms::owner_all);
  EXPECT_EQ(whyNot(copy), "");
}

TEST(DevicePlugin, FilesBelowFoldersThatOthersMayWriteAreNotLoaded) {
  const test::TemporaryFolder folder;
  const fs::path above = folder.path() / "above", inner = above / "inner", copy = inner / "copy.so";
  fs::create_directories(inner);
  fs::copy_file(kExamplePlugin, copy);
  for (const fs::path& each : {copy, inner, above})
    fs::permissions(each, fs::perms::owner_all);
  EXPECT_EQ(whyNot(copy), "");
  fs::permissions(above, fs::perms::owner_all | fs::perms::group_write);
  EXPECT_THAT(whyNot(copy), HasSubstr("other users can write to the folder " + above.string() + " above it"));
  // As /tmp: others may write to it, but replace nothing of ours.
  fs::permissions(above, fs::perms::all | fs::perms::sticky_bit);
  EXPECT_EQ(whyNot(copy), "");
}

TEST(DevicePlugin, AProgramWithMoreRightsThanItsCallerTakesNoFolderFromTheEnvironment) {
  const test::ScopedVariable named("NEARFIT_PLUGINS", "/home/nobody/named");
  const test::ScopedVariable data("XDG_DATA_HOME", "/home/nobody/data");
  EXPECT_THAT(pluginFolders(false), testing::ElementsAre(fs::path("/home/nobody/named")));
  const std::vector<fs::path> folders = pluginFolders(true);
  EXPECT_FALSE(folders.empty());
  for (const fs::path& each : folders)
    EXPECT_THAT(each.string(), testing::Not(testing::StartsWith("/home/nobody")));
}

// The file was once checked by its name and then loaded by its name.
TEST(DevicePlugin, WhatIsCheckedIsWhatIsLoadedHoweverItsNameChanges) {
  const test::TemporaryFolder folder;
  const fs::path trusted = folder.path() / "trusted", foreign = folder.path() / "foreign";
  const fs::path name = folder.path() / "name.so", next = folder.path() / "next.so";
  fs::copy_file(kExamplePlugin, trusted);
  fs::permissions(trusted, fs::perms::owner_all);
  std::ofstream(foreign) << "what somebody else wrote: if it were loaded, the loader would complain";
  fs::permissions(foreign, fs::perms::owner_all | fs::perms::others_write);
  fs::create_symlink(trusted, name);
  std::atomic<bool> isOver{false};
  std::thread attacker([&] {
    for (bool isForeign = true; !isOver; isForeign = !isForeign) {
      fs::create_symlink(isForeign ? foreign : trusted, next);
      fs::rename(next, name);
    }
  });
  std::set<std::string> answers;
  for (int i = 0; i < 2000; ++i)
    answers.insert(whyNot(name));
  isOver = true;
  attacker.join();
  for (const std::string& answer : answers)
    EXPECT_TRUE(answer.empty() || answer.find("other users can write to it") != std::string::npos) << answer;
}

TEST(DevicePlugin, TwoFilesAreTwoLibrariesWhateverWasLoadedBefore) {
  const test::TemporaryFolder folder;
  const fs::path one = folder.path() / "one.so", other = folder.path() / "other.so";
  for (const fs::path& file : {one, other}) {
    fs::copy_file(kExamplePlugin, file);
    fs::permissions(file, fs::perms::owner_all);
  }
  EXPECT_EQ(whyNot(one), "") << "its descriptor is free again";
  const auto first = DevicePlugin::load(other), second = DevicePlugin::load(one);
  EXPECT_NE(&first->functions(), &second->functions());
  EXPECT_EQ(&first->functions(), &DevicePlugin::load(other)->functions());
}

TEST(DevicePlugin, ThoseThatComeWithNearfitAreFoundBesideTheProgramAndInItsPrefix) {
  const test::ScopedVariable none("NEARFIT_PLUGINS", std::nullopt);
  const test::ScopedVariable data("XDG_DATA_HOME", "/home/nobody/data");
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path();
  const std::vector<fs::path> folders = pluginFolders();
  EXPECT_THAT(folders, testing::ElementsAre(
                           fs::path("/home/nobody/data/nearfit/plugins"), program / "plugins",
                           program.parent_path() / "lib/nearfit/plugins",
                           fs::path("/usr/local/lib/nearfit/plugins"), fs::path("/usr/lib/nearfit/plugins")));
}

TEST(DevicePlugin, ADescriptionThatMakesNoSenseIsRefused) {
  NearfitDeviceDescription good{};
  good.sensed_axes = 6;
  good.force_axes = 3;
  good.rate = 1000.0;
  EXPECT_EQ(descriptionProblem(good), "");
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
    NearfitDeviceDescription wrong = good;
    wrong.rate = bad;
    EXPECT_NE(descriptionProblem(wrong), "") << bad;
  }
  for (const int axes : {0, 4, 7}) {
    NearfitDeviceDescription wrong = good;
    wrong.sensed_axes = axes;
    EXPECT_NE(descriptionProblem(wrong), "") << axes;
  }
}

TEST(DevicePlugin, ARateThatTheServoCannotKeepIsRefused) {
  NearfitDeviceDescription device{};
  device.sensed_axes = device.force_axes = 3;
  for (const double rate : {0.0, 100.0, 1000.0, 20'000.0}) {
    device.rate = rate;
    EXPECT_EQ(descriptionProblem(device), "") << rate;
  }
  for (const double rate : {1e-9, 99.0, 20'001.0, 1e12}) {
    device.rate = rate;
    EXPECT_THAT(descriptionProblem(device), HasSubstr("from 100 to 20000 Hz")) << rate;
  }
}

TEST(DevicePlugin, FoldersAreSearchedAndProblemsAreTold) {
  const test::TemporaryFolder folder;
  const fs::path copy = folder.path() / "good.so", bad = folder.path() / "bad.so";
  fs::copy_file(kExamplePlugin, copy);
  fs::permissions(copy, fs::perms::owner_all);
  std::ofstream(bad) << "bad";
  std::ofstream(folder.path() / "readme.txt") << "not looked at";
  const test::ScopedVariable folders("NEARFIT_PLUGINS", folder.path().string() + ":/nonexistent");
  const PluginSearch search = loadPlugins(pluginFolders());
  ASSERT_EQ(search.plugins.size(), 1U);
  EXPECT_EQ(search.plugins[0]->file(), copy);
  ASSERT_EQ(search.problems.size(), 1U);
  EXPECT_THAT(search.problems[0], HasSubstr("bad.so"));
}

}  // namespace
}  // namespace nearfit::device_plugin_test
