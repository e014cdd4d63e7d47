#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/usb/driver_fixture.h"

namespace nearfit::driver_open_test {
namespace {

using testing::HasSubstr;

class DriverOpens : public test::EachDriver {};

TEST_P(DriverOpens, WhatIsPluggedInIsRecognised) {
  const std::vector<UsbDescription> seen = UsbBus().list();
  ASSERT_EQ(seen.size(), 1U);
  const auto match = recognise(seen[0]);
  ASSERT_TRUE(match);
  EXPECT_EQ(match->driver, bench->traits().driver);
  EXPECT_TRUE(match->isUsable());
  EXPECT_EQ(device->state(), DeviceState::Present);
  EXPECT_FALSE(emulated().isOpen()) << "looking at it and making its driver open nothing";
}

TEST_P(DriverOpens, OpenItSaysWhatItIsAndHoldsItsInterface) {
  bench->start(*device);
  EXPECT_EQ(device->state(), bench->traits().opened);
  const DeviceInfo info = device->info();
  EXPECT_THAT(info.name, HasSubstr(emulated().description().productName));
  EXPECT_EQ(info.forceAxes > 0, pushes());
  EXPECT_EQ(info.reportPeriod > 0.0, pushes()) << "those that push set the servo's pace";
  EXPECT_TRUE(emulated().isClaimed(0));
  EXPECT_FALSE(emulated().isKernelDriverBound(0));
  EXPECT_FALSE(bench->isPushing());
}

TEST_P(DriverOpens, ClosedItGivesBackWhatItHeld) {
  bringUp();
  ASSERT_TRUE(bench->round(*device, push, handle));
  bench->stopStreaming();
  device->stop();
  expectClosed(DeviceState::Present);
  EXPECT_FALSE(bench->isPushing());
  const bool hadDriver = !emulated().description().interfaces[0].kernelDriver.empty();
  EXPECT_EQ(emulated().isKernelDriverBound(0), hadDriver);
}

TEST_P(DriverOpens, ItCanBeOpenedAgainAndIsNotArmedByThat) {
  bringUp();
  for (int again = 0; again < 3; ++again) {
    bench->stopStreaming();
    device->stop();
    bench->start(*device);
    if (pushes()) {
      EXPECT_NE(device->state(), DeviceState::Armed);
    }
    EXPECT_FALSE(bench->isPushing());
  }
  ASSERT_TRUE(bench->round(*device, push, handle));
}

TEST_P(DriverOpens, NobodyArmsItBeforeItIsReady) {
  if (!pushes()) return;  // There is nothing to arm.
  EXPECT_THROW(device->arm(), DeviceError) << "it is not open";
  bench->start(*device);
  if (bench->traits().opened == DeviceState::Uncalibrated) {
    EXPECT_THROW(device->arm(), DeviceError);
    EXPECT_FALSE(device->stateNote().empty()) << "it says what it waits for";
    ASSERT_TRUE(bench->round(*device, push, handle));
    EXPECT_TRUE(handle.isClutched) << "what it says is no pose: the part stays";
  }
  for (int i = 0; i < 3; ++i)
    ASSERT_TRUE(bench->round(*device, push, handle));
  EXPECT_FALSE(handle.isArmed);
  EXPECT_FALSE(bench->isPushing());
}

TEST_P(DriverOpens, WhatAnotherProgramHoldsIsBusyAsLongAsItDoes) {
  emulated().claimElsewhere(0, true);
  EXPECT_EQ(errorOfStart().cause(), DeviceProblem::Busy);
  expectClosed(DeviceState::Present);
  emulated().claimElsewhere(0, false);
  bench->start(*device);
  EXPECT_EQ(device->state(), bench->traits().opened);
}

TEST_P(DriverOpens, WithoutPermissionItSaysHowToGetIt) {
  emulated().denyPermission(true);
  const DeviceError error = errorOfStart();
  EXPECT_EQ(error.cause(), DeviceProblem::NoPermission);
  EXPECT_THAT(error.remedy(), HasSubstr("udev rules"));
  expectClosed(DeviceState::Present);
  emulated().denyPermission(false);
  bench->start(*device);
  EXPECT_EQ(device->state(), bench->traits().opened);
}

TEST_P(DriverOpens, WhatWasPulledOutBeforeIsGone) {
  bus.unplug(emulated());
  EXPECT_EQ(errorOfStart().cause(), DeviceProblem::Gone);
  expectClosed(DeviceState::Absent);
}

TEST_P(DriverOpens, ADeviceThatAnswersNothingHoldsNobodyUpAndLeavesNothingBehind) {
  emulated().hang(true);
  const std::optional<DeviceProblem> problem = bench->traits().whenSilent;
  if (problem) {
    EXPECT_EQ(errorOfStart().cause(), *problem);
  } else {
    device->start({});
    EXPECT_EQ(device->state(), bench->traits().opened);
    EXPECT_TRUE(device->readHandle(handle));
    device->sendWrench(push);
    device->stop();
  }
  expectClosed(DeviceState::Present);
}

TEST_P(DriverOpens, ADeviceThatRefusesRequestsSaysSoOrDoesWithout) {
  bus.unplug(emulated());
  emulated().onControl = [](const test::ControlRequest&) { return std::nullopt; };
  bus.plug(bench->emulated());
  make();
  if (const std::optional<DeviceProblem> problem = bench->traits().whenRefusing) {
    EXPECT_EQ(errorOfStart().cause(), *problem);
    expectClosed(DeviceState::Present);
    return;
  }
  bringUp();
  EXPECT_TRUE(bench->round(*device, push, handle));
}

INSTANTIATE_TEST_SUITE_P(All, DriverOpens, testing::ValuesIn(test::kDriverKinds), test::nameOf);

}  // namespace
}  // namespace nearfit::driver_open_test
