#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "device/polhem/polhem_device.h"
#include "device/usb/usb_bus.h"
#include "tests/usb/emulated_bus.h"
#include "tests/usb/hand_servo.h"
#include "tests/usb/polhem_emulator.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::polhem_usb_test {
namespace {

using test::PolhemEmulator;
using testing::HasSubstr;

class PolhemOverUsb : public testing::Test {
 protected:
  explicit PolhemOverUsb(PolhemEmulator::Board board = PolhemEmulator::Board::Own) : emulator(board) {
    // On a loaded machine a thread may not run for a while.
    safety.patience = {10.0, 10.0};
    bus.plug(emulator.device());
    const std::vector<UsbDescription> seen = UsbBus().list();
    if (seen.size() == 1) device = std::make_unique<PolhemDevice>(seen[0], calibration, safety);
  }
  void SetUp() override { ASSERT_TRUE(device) << "it is not seen on the bus"; }

  /// As the user does: held in the rest, at these counts, wherever the device was switched on.
  void calibrateAt(const std::array<int, 6>& counts) {
    emulator.withFirmware([&](test::PolhemFirmware& firmware) { firmware.counts = counts; });
    ASSERT_TRUE(test::serve(*device, 2, {}, handle));
    device->calibrate();
    ASSERT_TRUE(test::serve(*device, 2, {}, handle));
    ASSERT_EQ(device->state(), DeviceState::Ready);
  }

  /// What its motors are to do [mA].
  std::array<int, 3> told() {
    return emulator.withFirmware([](const auto& firmware) { return firmware.told(); });
  }

  const polhem::Calibration calibration;
  const polhem::Kinematics kinematics{calibration};
  const std::array<int, 6> rest{1000, -200, 30, 0, 0, 0};
  const Wrench push{{1.0, -0.5, 2.0}, {0.0, 0.0, 0.0}};
  const std::array<int, 3> none{};
  SafetyLimits safety;
  test::EmulatedBus bus;
  PolhemEmulator emulator;
  std::unique_ptr<PolhemDevice> device;
  HandleInput handle;
};

class PolhemOnATeensy : public PolhemOverUsb {
 protected:
  PolhemOnATeensy() : PolhemOverUsb(PolhemEmulator::Board::Teensy) {}
};

TEST_F(PolhemOverUsb, IsUncalibratedUntilItIsHeldInItsRest) {
  device->start({});
  emulator.stream();
  EXPECT_EQ(device->state(), DeviceState::Uncalibrated);
  EXPECT_THAT(device->stateNote(), HasSubstr("rest"));
  EXPECT_THROW(device->arm(), DeviceError);
  emulator.withFirmware([](test::PolhemFirmware& firmware) { firmware.counts = {123, 45, 6, 0, 0, 0}; });
  ASSERT_TRUE(test::serve(*device, 3, push, handle));
  EXPECT_TRUE(handle.isClutched) << "what it says is no pose: the part stays";
  EXPECT_FALSE(handle.isArmed);
  EXPECT_EQ(told(), none);
  calibrateAt(rest);
  EXPECT_FALSE(handle.isClutched);
  EXPECT_EQ(handle.pose.translation, kinematics.positionOf(kinematics.restAngles().arm));
}

TEST_F(PolhemOverUsb, ItsButtonCalibratesItWhenPressedNotWhenItHadBeen) {
  emulator.withFirmware([](test::PolhemFirmware& firmware) { firmware.isButtonFlagged = true; });
  device->start({});
  emulator.stream();
  ASSERT_TRUE(test::serve(*device, 5, {}, handle));
  EXPECT_EQ(device->state(), DeviceState::Uncalibrated) << "that was before anyone looked";
  emulator.withFirmware([](test::PolhemFirmware& firmware) { firmware.isButtonFlagged = false; });
  ASSERT_TRUE(test::serve(*device, 3, {}, handle));
  emulator.withFirmware([](test::PolhemFirmware& firmware) { firmware.isButtonFlagged = true; });
  ASSERT_TRUE(test::serve(*device, 3, {}, handle));
  EXPECT_EQ(device->state(), DeviceState::Ready);
}

TEST_F(PolhemOverUsb, CalibrationHoldsUntilItIsUnplugged) {
  device->start({});
  emulator.stream();
  calibrateAt(rest);
  emulator.stopStreaming();
  device->stop();
  device->start({});
  EXPECT_EQ(device->state(), DeviceState::Ready);
}

TEST_F(PolhemOverUsb, ItIsNotCalibratedWhileItPushes) {
  device->start({});
  emulator.stream();
  calibrateAt(rest);
  device->arm();
  EXPECT_THROW(device->calibrate(), DeviceError);
}

TEST_F(PolhemOverUsb, JointsWhereTheyCannotBeStopItAndUndoItsCalibration) {
  device->start({});
  emulator.stream();
  calibrateAt(rest);
  device->arm();
  // 16 x 2000 counts a turn: 120 degrees, of 100.
  emulator.withFirmware([&](test::PolhemFirmware& firmware) { firmware.counts[0] = rest[0] + 10667; });
  ASSERT_TRUE(test::serve(*device, 3, push, handle));
  EXPECT_EQ(device->state(), DeviceState::Fault);
  EXPECT_THAT(device->stateNote(), HasSubstr("calibration"));
  EXPECT_FALSE(handle.isArmed);
  EXPECT_TRUE(test::eventually([&] { return told() == none; }));
  emulator.stopStreaming();
  device->start({});
  EXPECT_EQ(device->state(), DeviceState::Uncalibrated);
}

TEST_F(PolhemOnATeensy, FullPacketsAreExchangedOverTheRightInterface) {
  device->start({});
  EXPECT_TRUE(emulator.device()->isClaimed(0));
  EXPECT_FALSE(emulator.device()->isClaimed(1));
  emulator.stream();
  calibrateAt(rest);
  device->arm();
  ASSERT_TRUE(test::serve(*device, 50, push, handle));
  EXPECT_TRUE(test::eventually([&] { return told() != none; }));
  EXPECT_EQ(emulator.withFirmware([](const auto& firmware) { return firmware.ignored(); }), 0U);
}

}  // namespace
}  // namespace nearfit::polhem_usb_test
