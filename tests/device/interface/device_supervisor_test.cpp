#include "device/interface/device_supervisor.h"

#include <limits>

#include <gtest/gtest.h>

#include "device/interface/device_error.h"

namespace nearfit::device_supervisor_test {
namespace {

constexpr DeviceSupervisor::Sample kCalm{0.001, 0.1, true};

struct Open {
  explicit Open(const SafetyLimits& limits = {}, bool isCalibrated = true) {
    device.beginOpening();
    device.opened(limits, isCalibrated);
  }
  DeviceSupervisor device;
};

TEST(DeviceSupervisor, ForcesGoOutOnlyWhenArmed) {
  Open open;
  EXPECT_EQ(open.device.state(), DeviceState::Ready);
  EXPECT_FALSE(open.device.check(kCalm));
  open.device.arm("it");
  EXPECT_TRUE(open.device.check(kCalm));
  open.device.disarm();
  EXPECT_FALSE(open.device.check(kCalm));
}

TEST(DeviceSupervisor, WhatIsNotCalibratedIsNotArmed) {
  Open open({}, false);
  EXPECT_THROW(open.device.arm("it"), DeviceError);
  open.device.calibrated();
  open.device.arm("it");
  EXPECT_EQ(open.device.state(), DeviceState::Armed);
}

TEST(DeviceSupervisor, WhatForgetsItsPoseIsUncalibratedOrStopped) {
  Open open;
  open.device.uncalibrated();
  EXPECT_EQ(open.device.state(), DeviceState::Uncalibrated);
  open.device.calibrated();
  open.device.arm("it");
  EXPECT_TRUE(open.device.check(kCalm));
  open.device.uncalibrated();
  EXPECT_EQ(open.device.state(), DeviceState::Fault);
  EXPECT_EQ(open.device.fault(), DeviceFault::PoseUnknown);
  EXPECT_FALSE(open.device.check(kCalm));
  open.device.reset();
  EXPECT_EQ(open.device.state(), DeviceState::Uncalibrated);
}

TEST(DeviceSupervisor, APoseThatIsForgottenInAFaultIsStillUnknownOnceItIsReset) {
  // After its power was off a device was ready again, with its pose anywhere.
  Open open;
  open.device.arm("it");
  open.device.stop(DeviceFault::SwitchedOff);
  open.device.uncalibrated();
  EXPECT_EQ(open.device.fault(), DeviceFault::SwitchedOff) << "the first reason is kept";
  open.device.reset();
  EXPECT_EQ(open.device.state(), DeviceState::Uncalibrated);
  open.device.lost();
  open.device.uncalibrated();
  EXPECT_EQ(open.device.state(), DeviceState::Lost);
}

TEST(DeviceSupervisor, AFaultThatIsForgottenDoesNotCalibrate) {
  // Garbage from a device that was uncalibrated left it ready once it was reset.
  Open open({}, false);
  open.device.stop(DeviceFault::Garbage);
  EXPECT_EQ(open.device.state(), DeviceState::Fault);
  open.device.reset();
  EXPECT_EQ(open.device.state(), DeviceState::Uncalibrated);
  open.device.calibrated();
  open.device.stop(DeviceFault::Silent);
  open.device.reset();
  EXPECT_EQ(open.device.state(), DeviceState::Ready);
  open.device.stop(DeviceFault::OutOfReach);
  open.device.reset();
  EXPECT_EQ(open.device.state(), DeviceState::Uncalibrated) << "its calibration has proved wrong";
}

TEST(DeviceSupervisor, IsCalibratedOnlyWhileItIsOpenWholeAndNotArmed) {
  Open open;
  EXPECT_NO_THROW(open.device.requireCalibratable("it"));
  open.device.arm("it");
  EXPECT_THROW(open.device.requireCalibratable("it"), DeviceError);
  open.device.stop(DeviceFault::Silent);
  EXPECT_THROW(open.device.requireCalibratable("it"), DeviceError);
  open.device.lost();
  EXPECT_THROW(open.device.requireCalibratable("it"), DeviceError);
  open.device.closed(DeviceState::Present);
  EXPECT_THROW(open.device.requireCalibratable("it"), DeviceError);
  EXPECT_NO_THROW(Open({}, false).device.requireCalibratable("it"));
}

TEST(DeviceSupervisor, SilenceStopsItAndNothingArmsItAgainByItself) {
  Open open;
  open.device.arm("it");
  EXPECT_TRUE(open.device.check({0.0199, 0.0, true}));
  EXPECT_FALSE(open.device.check({0.0201, 0.0, true}));
  EXPECT_EQ(open.device.state(), DeviceState::Fault);
  EXPECT_EQ(open.device.fault(), DeviceFault::Silent);
  EXPECT_FALSE(open.device.check(kCalm)) << "poses come again";
  EXPECT_THROW(open.device.arm("it"), DeviceError);
  open.device.reset();
  EXPECT_EQ(open.device.state(), DeviceState::Ready);
  EXPECT_FALSE(open.device.check(kCalm));
}

TEST(DeviceSupervisor, ADeviceThatIsSlowByItsNatureIsWaitedFor) {
  SafetyLimits usual;
  usual.keepPace(1e-3);
  EXPECT_DOUBLE_EQ(usual.patience.hold, 0.005);
  EXPECT_DOUBLE_EQ(usual.patience.silence, 0.020);
  // A hundred reports a second: two of them for holding, four until it is silent.
  SafetyLimits slow;
  slow.keepPace(1e-2);
  EXPECT_DOUBLE_EQ(slow.patience.hold, 0.020);
  EXPECT_DOUBLE_EQ(slow.patience.silence, 0.040);
  Open open(slow);
  open.device.arm("it");
  EXPECT_TRUE(open.device.check({0.0399, 0.0, true}));
  EXPECT_FALSE(open.device.check({0.0401, 0.0, true}));
  EXPECT_EQ(open.device.fault(), DeviceFault::Silent);
}

TEST(DeviceSupervisor, NumbersThatAreNoneStopIt) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const DeviceSupervisor::Sample& sample :
       {DeviceSupervisor::Sample{nan, 0.0, true}, {0.0, nan, true}}) {
    Open open;
    open.device.arm("it");
    EXPECT_FALSE(open.device.check(sample));
    EXPECT_EQ(open.device.state(), DeviceState::Fault);
  }
}

TEST(DeviceSupervisor, FirstFaultStays) {
  Open open;
  open.device.arm("it");
  open.device.stop(DeviceFault::Reported);
  open.device.stop(DeviceFault::Garbage);
  EXPECT_EQ(open.device.fault(), DeviceFault::Reported);
}

TEST(DeviceSupervisor, ReplugIsReadyNeverArmed) {
  Open open;
  open.device.arm("it");
  open.device.lost();
  EXPECT_EQ(open.device.state(), DeviceState::Lost);
  EXPECT_FALSE(open.device.check(kCalm));
  open.device.disarm();
  open.device.calibrated();
  EXPECT_EQ(open.device.state(), DeviceState::Lost);
  open.device.beginOpening();
  open.device.opened({}, true);
  EXPECT_EQ(open.device.state(), DeviceState::Ready);
  EXPECT_FALSE(open.device.check(kCalm));
}

TEST(DeviceSupervisor, LossWhileOpeningIsNotForgotten) {
  DeviceSupervisor device;
  device.beginOpening();
  device.lost();
  device.opened({}, true);
  EXPECT_EQ(device.state(), DeviceState::Lost);
}

TEST(DeviceSupervisor, DeadManSwitchHoldsForcesBackWithoutDisarming) {
  SafetyLimits limits;
  limits.hasDeadMan = true;
  Open open(limits);
  open.device.arm("it");
  EXPECT_FALSE(open.device.check({0.001, 0.0, false}));
  EXPECT_EQ(open.device.state(), DeviceState::Armed);
  EXPECT_TRUE(open.device.check({0.001, 0.0, true}));
}

TEST(DeviceSupervisor, BrakeOpposesMotionBeyondItsSpeedWithinTheLimit) {
  SafetyLimits limits;
  limits.brakeSpeed = 1.0;
  limits.brakeDamping = 5.0;
  Open open(limits);
  open.device.arm("it");
  ASSERT_TRUE(open.device.check({0.001, 1.5, true}));
  const Wrench wanted{{1.0, 0.0, 0.0}, {0.0, 0.2, 0.0}};
  EXPECT_EQ(open.device.guarded(wanted, {1.0, 0.0, 0.0}, 10.0).force.x, 1.0);
  EXPECT_NEAR(open.device.guarded(wanted, {1.5, 0.0, 0.0}, 10.0).force.x, 1.0 - 5.0 * 0.5, 1e-12);
  EXPECT_NEAR(open.device.guarded(wanted, {2.9, 0.0, 0.0}, 4.0).force.x, -4.0, 1e-12);
  open.device.disarm();
  EXPECT_EQ(open.device.guarded(wanted, {0.0, 0.0, 0.0}, 10.0).force.x, 0.0) << "disarmed since the check";
}

}  // namespace
}  // namespace nearfit::device_supervisor_test
