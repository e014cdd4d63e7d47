#include <glm/geometric.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/falcon/falcon_device.h"
#include "device/falcon/falcon_kinematics.h"
#include "device/interface/device_error.h"
#include "device/usb/usb_bus.h"
#include "tests/support/temporary_folder.h"
#include "tests/usb/emulated_bus.h"
#include "tests/usb/falcon_emulator.h"
#include "tests/usb/hand_servo.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::falcon_usb_test {
namespace {

using testing::HasSubstr;

/// Some blocks and a part of one.
const std::string kImage(1000, 'f');

class FalconOverUsb : public testing::Test {
 protected:
  FalconOverUsb() {
    // On a loaded machine a thread may not run for a while.
    safety.patience = {10.0, 10.0};
    bus.plug(emulator.device());
    const std::vector<UsbDescription> seen = UsbBus().list();
    if (seen.size() == 1) device = std::make_unique<FalconDevice>(seen[0], file, safety);
  }
  void SetUp() override { ASSERT_TRUE(device) << "it is not seen on the bus"; }

  template <class Use>
  auto with(Use&& use) {
    return emulator.withFirmware(std::forward<Use>(use));
  }
  /// As the user does: out and in past the indexes, then held near the middle.
  void home() {
    with([](test::FalconFirmware& firmware) { firmware.indexesPassed = 7; });
    ASSERT_TRUE(test::serve(*device, 5, {}, handle));
    ASSERT_EQ(device->state(), DeviceState::Ready);
  }
  DeviceError errorOfStart() {
    try {
      device->start({});
    } catch (const DeviceError& error) {
      return error;
    }
    ADD_FAILURE() << "no error";
    return {DeviceProblem::Failed, "", ""};
  }

  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.write("firmware.bin", kImage);
  const Wrench push{{0.5, -1.0, 2.0}, {0.0, 0.0, 0.0}};
  const std::array<std::int16_t, 3> none{};
  SafetyLimits safety;
  test::EmulatedBus bus;
  test::FalconEmulator emulator{test::bytesOf(std::as_bytes(std::span(kImage)))};
  std::unique_ptr<FalconDevice> device;
  HandleInput handle;
};

TEST_F(FalconOverUsb, IsGivenItsFirmwareAndWaitsForItsHandleToBeMoved) {
  device->start({});
  EXPECT_TRUE(with([](const auto& firmware) { return firmware.isRunning(); }));
  EXPECT_EQ(device->state(), DeviceState::Uncalibrated);
  EXPECT_THAT(device->stateNote(), HasSubstr("pull"));
  EXPECT_THROW(device->arm(), DeviceError);
  ASSERT_TRUE(test::serve(*device, 5, push, handle));
  EXPECT_TRUE(handle.isClutched);
  EXPECT_TRUE(with([](const auto& firmware) { return firmware.isHoming(); }));
  EXPECT_EQ(with([](const auto& firmware) { return firmware.lights(); }), falcon::kRed);
  EXPECT_EQ(with([](const auto& firmware) { return firmware.torques(); }), none);
  // Two of three are not enough.
  with([](test::FalconFirmware& firmware) { firmware.indexesPassed = 5; });
  ASSERT_TRUE(test::serve(*device, 5, push, handle));
  EXPECT_EQ(device->state(), DeviceState::Uncalibrated);
  home();
  EXPECT_FALSE(handle.isClutched);
  ASSERT_TRUE(test::serve(*device, 2, push, handle));
  EXPECT_FALSE(with([](const auto& firmware) { return firmware.isHoming(); }));
  EXPECT_EQ(with([](const auto& firmware) { return firmware.lights(); }), falcon::kGreen);
}

TEST_F(FalconOverUsb, FirmwareThatRunsIsNotLoadedAgain) {
  with([](test::FalconFirmware& firmware) { firmware.run(); });
  FalconDevice withoutFile(UsbBus().list().at(0), {}, safety);
  withoutFile.start({});
  EXPECT_EQ(withoutFile.state(), DeviceState::Uncalibrated);
  EXPECT_EQ(with([](const auto& firmware) { return firmware.uploads(); }), 0);
}

TEST_F(FalconOverUsb, WithoutAFileItSaysWhatItNeeds) {
  FalconDevice withoutFile(UsbBus().list().at(0), {}, safety);
  try {
    withoutFile.start({});
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_EQ(error.cause(), DeviceProblem::NoFirmware);
  }
  EXPECT_EQ(withoutFile.state(), DeviceState::Present);
  EXPECT_EQ(emulator.device()->outstanding(), 0U);
}

TEST_F(FalconOverUsb, OpeningEndsWithTheNextRequestOnceNobodyWantsIt) {
  // Without power each of a hundred greetings would be waited for.
  with([](auto& firmware) { firmware.isPowered = false; });
  int asked = 0;
  EXPECT_THROW(device->start({}, [&](double) { return ++asked < 6; }), Cancelled);
  EXPECT_EQ(asked, 6);
  EXPECT_EQ(device->state(), DeviceState::Present);
  EXPECT_EQ(emulator.device()->outstanding(), 0U);
  with([](auto& firmware) { firmware.isPowered = true; });
  device->start({});
  EXPECT_EQ(device->state(), DeviceState::Uncalibrated);
}

TEST_F(FalconOverUsb, AFailedUploadLeavesItClosed) {
  with([](test::FalconFirmware& firmware) { firmware.mostBytes = 100; });
  EXPECT_THAT(errorOfStart().problem(), HasSubstr("stopped accepting firmware"));
  EXPECT_EQ(device->state(), DeviceState::Present);
  EXPECT_FALSE(emulator.device()->isOpen());
}

TEST_F(FalconOverUsb, ThePoseIsThatOfItsThighs) {
  device->start({});
  home();
  const glm::dvec3 place(0.01, -0.02, 0.12);
  const glm::dvec3 angles = *falcon::inverse(place);
  // A count is 360 / 1280 degrees of the motor, and 14.25 / 110 of that of the thigh.
  const double degreesPerCount = 360.0 / 1280.0 * 14.25 / 110.0;
  with([&](test::FalconFirmware& firmware) {
    for (int i = 0; i < 3; ++i)
      firmware.encoders[static_cast<std::size_t>(i)] =
          static_cast<std::int16_t>(std::lround((glm::degrees(angles[i]) - 35.0) / degreesPerCount));
    firmware.buttons = 6;
  });
  ASSERT_TRUE(test::serve(*device, 3, {}, handle));
  // Half a count on each thigh of 60 mm.
  EXPECT_LT(glm::distance(handle.pose.translation, place), 3.0 * 0.5 * glm::radians(degreesPerCount) * 0.060);
  EXPECT_EQ(handle.pose.rotation, glm::dquat(1.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(handle.buttons, 6U);
  EXPECT_FALSE(handle.isClutched);
  EXPECT_TRUE(handle.hasOwnFrame);
  with([](test::FalconFirmware& firmware) { firmware.buttons = 1; });
  ASSERT_TRUE(test::serve(*device, 3, {}, handle));
  EXPECT_TRUE(handle.isClutched) << "its first button is the clutch";
}

TEST_F(FalconOverUsb, ThighsThatCannotBeThereStopIt) {
  device->start({});
  home();
  device->arm();
  with([](test::FalconFirmware& firmware) { firmware.encoders = {32000, 0, 0}; });
  // Each command brings one such report; none of them is a pose to wait for.
  for (unsigned i = 0; i < ReportStream<ArmSample>::kMaxRejectedInRow + 2; ++i) {
    const std::uint64_t before =
        emulator.withFirmware([](const auto& firmware) { return firmware.commands(); });
    device->readHandle(handle);
    device->sendWrench(push);
    ASSERT_TRUE(test::eventually(
        [&] { return with([](const auto& firmware) { return firmware.commands(); }) > before; }));
  }
  EXPECT_TRUE(test::eventually([&] { return device->state() == DeviceState::Fault; }));
  EXPECT_THAT(device->stateNote(), HasSubstr("calibration"));
  device->sendWrench(push);
  EXPECT_TRUE(test::eventually(
      [&] { return with([](const auto& firmware) { return firmware.torques(); }) == none; }));
}

}  // namespace
}  // namespace nearfit::falcon_usb_test
