#include "device/openhap/openhap_device.h"

#include <memory>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/interface/device_error.h"
#include "tests/usb/hand_servo.h"
#include "tests/usb/openhap_emulator.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::openhap_device_test {
namespace {

using test::eventually;
using test::SteadyServo;
using testing::HasSubstr;

class OpenHapOverUsb : public testing::Test {
 protected:
  void use(const openhap::Capabilities& capabilities) {
    emulator = std::make_unique<test::OpenHapEmulator>(capabilities);
    bus.plug(emulator->device());
    open();
  }
  /// As plugged in now.
  void open() {
    const std::vector<UsbDescription> seen = UsbBus().list();
    ASSERT_EQ(seen.size(), 1U);
    ASSERT_TRUE(OpenHapDevice::speaks(seen[0]));
    device = std::make_unique<OpenHapDevice>(seen[0], safety);
  }
  bool isArmed() {
    return emulator->withFirmware([](const auto& firmware) { return firmware.isArmed(); });
  }
  double force() { return emulator->rendered().force[0]; }

  static openhap::Capabilities usual() { return test::OpenHapEmulator::usualCapabilities(); }
  /// On a loaded machine a thread may not run for a while: neither side stops for that.
  openhap::Capabilities lenient() {
    safety.patience = {10.0, 10.0};
    openhap::Capabilities is = usual();
    is.watchdogMs = 10'000;
    return is;
  }

  test::EmulatedBus bus;
  SafetyLimits safety;
  std::unique_ptr<test::OpenHapEmulator> emulator;
  std::unique_ptr<OpenHapDevice> device;
  const Wrench push{{2.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
};

TEST_F(OpenHapOverUsb, OpensReadyAndSaysWhatItIs) {
  use(usual());
  EXPECT_EQ(device->state(), DeviceState::Present);
  device->start({});
  EXPECT_EQ(device->state(), DeviceState::Ready);
  const DeviceInfo info = device->info();
  EXPECT_THAT(info.name, HasSubstr("OpenHap emulator"));
  EXPECT_EQ(info.forceAxes, 6);
  EXPECT_DOUBLE_EQ(info.reportPeriod, 1e-3);
  EXPECT_DOUBLE_EQ(info.limits.maxForce, 8.0);
  EXPECT_DOUBLE_EQ(info.limits.maxTorque, 0.5);
  device->stop();
  EXPECT_EQ(device->state(), DeviceState::Present);
  EXPECT_EQ(emulator->device()->outstanding(), 0U);
}

TEST_F(OpenHapOverUsb, TurningIsUnfeltOnlyIfItIsSensedAndMeetsNoTorque) {
  for (const bool sensesOrientation : {false, true}) {
    for (const bool rendersTorque : {false, true}) {
      openhap::Capabilities capabilities = lenient();
      capabilities.sensesOrientation = sensesOrientation;
      capabilities.rendersTorque = rendersTorque;
      use(capabilities);
      device->start({});
      const DeviceInfo info = device->info();
      EXPECT_EQ(info.sensedAxes, sensesOrientation ? 6 : 3);
      EXPECT_EQ(info.forceAxes, rendersTorque ? 6 : 3);
      HandleInput handle;
      ASSERT_TRUE(device->readHandle(handle));
      EXPECT_EQ(handle.isTorqueFelt, rendersTorque || !sensesOrientation);
      EXPECT_EQ(info.isTurningUnfelt(), !handle.isTorqueFelt);
      device->stop();
      bus.unplug(*emulator->device());
    }
  }
}

TEST_F(OpenHapOverUsb, PosesComeInAndWrenchesGoOutOnceArmed) {
  use(lenient());
  device->start({});
  emulator->stream({.hand = [](test::OpenHapFirmware& firmware, double) {
    firmware.handle.position = {0.01F, -0.02F, 0.03F};
    firmware.handle.rotation = {0.0F, 1.0F, 0.0F, 0.0F};
    firmware.handle.buttons = 2;
  }});
  SteadyServo servo(*device, push);
  const auto accepted = [&] {
    return emulator->withFirmware([](const auto& firmware) { return firmware.accepted(); });
  };
  ASSERT_TRUE(eventually([&] { return device->counters().poses >= 20 && accepted() >= 20; }));
  EXPECT_EQ(force(), 0.0) << "nobody has armed it";
  device->arm();
  EXPECT_EQ(device->state(), DeviceState::Armed);
  EXPECT_TRUE(isArmed());
  EXPECT_TRUE(eventually([&] { return force() == 2.0; }));
  device->disarm();
  EXPECT_FALSE(isArmed());
  EXPECT_TRUE(eventually([&] { return force() == 0.0; })) << "it fades";
  EXPECT_EQ(device->state(), DeviceState::Ready);
  const HandleInput last = servo.stop();
  EXPECT_NEAR(last.pose.translation.x, 0.01, 1e-8);
  EXPECT_NEAR(last.pose.translation.y, -0.02, 1e-8);
  EXPECT_NEAR(last.pose.translation.z, 0.03, 1e-8);
  EXPECT_DOUBLE_EQ(last.pose.rotation.x, 1.0);
  EXPECT_EQ(last.buttons, 2U);
  EXPECT_FALSE(last.isClutched);
  EXPECT_TRUE(last.hasOwnFrame);
  EXPECT_EQ(device->counters().rejected, 0U);
  EXPECT_EQ(device->counters().missing, 0U);
}

TEST_F(OpenHapOverUsb, TheFirmwaresWatchdogStopsItAndIsReported) {
  use(usual());
  device->start({});
  emulator->stream();
  ASSERT_TRUE(eventually([&] { return device->counters().poses >= 5; }));
  device->arm();
  // No servo answers.
  ASSERT_TRUE(eventually([&] { return device->state() == DeviceState::Fault; }));
  EXPECT_FALSE(isArmed());
  EXPECT_EQ(device->stateNote(), "it reported a fault");
  EXPECT_THROW(device->arm(), DeviceError);
  // Only being reset makes both sides forget it, and does not arm.
  device->reset();
  const std::uint64_t poses = device->counters().poses;
  ASSERT_TRUE(eventually([&] { return device->counters().poses >= poses + 5; }));
  EXPECT_EQ(device->state(), DeviceState::Ready);
  EXPECT_FALSE(isArmed());
  device->arm();
  ASSERT_TRUE(eventually([&] { return device->state() == DeviceState::Fault; }));
  device->stop();
  emulator->stopStreaming();
  device->start({});
  EXPECT_EQ(device->state(), DeviceState::Ready);
}

TEST_F(OpenHapOverUsb, AFaultOfItsOwnIsToldInTheDevicesWordsUntilItIsReset) {
  use(lenient());
  device->start({});
  emulator->stream();
  SteadyServo servo(*device, push);
  ASSERT_TRUE(eventually([&] { return servo.hasRead(); }));
  const auto saysOf = [&](const std::string& fault) {
    emulator->withFirmware([&](auto& firmware) { firmware.fault = fault; });
    return eventually([&] { return device->state() == DeviceState::Fault; }) &&
                   eventually([&] { return device->stateNote() != "it reported a fault"; })
               ? device->stateNote()
               : "nothing";
  };
  // Each is asked for anew; what would play with a terminal does not get there, nor more than fits.
  for (const auto& [fault, told] :
       {std::pair<std::string, std::string>{"motor 2 is too hot", "motor 2 is too hot"},
        {"cable\x1b[2J broken\n", "cable?[2J broken?"},
        {std::string(100, 'x'), std::string(64, 'x')}}) {
    device->arm();
    EXPECT_EQ(saysOf(fault), "it reported a fault: " + told);
    // Over now; the reports that tell of it may be on their way still.
    emulator->withFirmware([](auto& firmware) { firmware.fault.clear(); });
    const std::uint64_t poses = device->counters().poses;
    ASSERT_TRUE(eventually([&] { return device->counters().poses >= poses + 10; }));
    device->reset();
    ASSERT_TRUE(eventually([&] { return device->state() == DeviceState::Ready; }));
    EXPECT_EQ(device->stateNote(), "");
  }
}

TEST_F(OpenHapOverUsb, WrenchesOfASlowDeviceLiveForThreeOfItsPeriods) {
  openhap::Capabilities slow = lenient();
  slow.rate = 100;
  use(slow);
  device->start({});
  emulator->stream();
  SteadyServo servo(*device, push);
  ASSERT_TRUE(eventually(
      [&] { return emulator->withFirmware([](const auto& firmware) { return firmware.accepted() > 0; }); }));
  EXPECT_EQ(emulator->withFirmware([](const auto& firmware) { return firmware.lastWrench().timeToLiveMs; }),
            30);
}

TEST_F(OpenHapOverUsb, ForcesNeedTheDeadMansSwitch) {
  openhap::Capabilities capabilities = lenient();
  capabilities.hasDeadMan = true;
  use(capabilities);
  device->start({});
  emulator->stream();
  SteadyServo servo(*device, push);
  ASSERT_TRUE(eventually([&] { return servo.hasRead(); }));
  device->arm();
  const auto lastForce = [&] {
    return emulator->withFirmware([](const auto& firmware) { return firmware.lastWrench().force[0]; });
  };
  const auto hold = [&](bool isHeld) {
    emulator->withFirmware([&](auto& firmware) { firmware.isDeadManHeld = isHeld; });
  };
  EXPECT_EQ(lastForce(), 0.0F);
  hold(true);
  EXPECT_TRUE(eventually([&] { return force() == 2.0; }));
  hold(false);
  EXPECT_TRUE(eventually([&] { return force() == 0.0; })) << "the device stops, as its own test tells";
  EXPECT_TRUE(eventually([&] { return lastForce() == 0.0F; })) << "and so does the host";
  EXPECT_EQ(device->state(), DeviceState::Armed);
}

TEST_F(OpenHapOverUsb, DamagedPosesAreCountedAndNotBelieved) {
  use(lenient());
  device->start({});
  emulator->stream({.damage =
                        [](test::Bytes& bytes, std::uint64_t number) {
                          if (number % 4 == 1) bytes[10] ^= std::byte{1};
                          if (number % 4 == 2) bytes.resize(20);
                          if (number % 4 == 3) bytes.resize(100);
                        },
                    .count = 400});
  emulator->join();
  ASSERT_TRUE(eventually([&] {
    return device->counters().poses + device->counters().rejected + device->linkCounters().oversized == 400;
  }));
  EXPECT_EQ(device->counters().poses, 100U);
  EXPECT_EQ(device->counters().rejected, 200U);
  EXPECT_EQ(device->counters().missing, 297U) << "three between each two of a hundred";
  EXPECT_EQ(device->state(), DeviceState::Ready);
}

TEST_F(OpenHapOverUsb, WhatIsNotHomedCannotBeArmed) {
  openhap::Capabilities capabilities = lenient();
  capabilities.needsHoming = true;
  use(capabilities);
  device->start({});
  EXPECT_EQ(device->state(), DeviceState::Uncalibrated);
  emulator->stream();
  EXPECT_THROW(device->arm(), DeviceError);
  EXPECT_FALSE(isArmed());
  device->calibrate();
  EXPECT_TRUE(emulator->withFirmware([](auto& firmware) { return firmware.isHomed; }));
  EXPECT_TRUE(eventually([&] { return device->state() == DeviceState::Ready; }));
}

TEST_F(OpenHapOverUsb, ANewerMajorVersionIsRefused) {
  openhap::Capabilities capabilities = usual();
  capabilities.major = 2;
  use(capabilities);
  try {
    device->start({});
    FAIL() << "it was opened";
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.cause(), DeviceProblem::Unsupported);
    EXPECT_THAT(error.what(), HasSubstr("version 2"));
  }
  EXPECT_EQ(device->state(), DeviceState::Present);
  EXPECT_FALSE(emulator->device()->isOpen());
}

}  // namespace
}  // namespace nearfit::openhap_device_test
