#include <array>
#include <chrono>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "device/spacemouse/spacemouse_device.h"
#include "device/usb/usb_bus.h"
#include "tests/usb/driver_bench.h"
#include "tests/usb/emulated_bus.h"
#include "tests/usb/spacemouse_emulator.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::spacemouse_usb_test {
namespace {

using test::eventually;
using test::SpaceMouseFirmware;
using Counts = std::array<std::int16_t, 6>;
using Model = SpaceMouseFirmware::Model;

constexpr double kFullScale = 350.0;
/// The device has y towards the user and z down; the driver y away and z up.
constexpr std::array<double, 6> kSigns = {1.0, -1.0, -1.0, 1.0, -1.0, -1.0};

/// What is the space mouse's own; what it shares with other drivers: driver_*_test.cpp.
class SpaceMouseOverUsb : public testing::Test {
 protected:
  void use(Model model) {
    emulator = std::make_unique<test::SpaceMouseEmulator>(model);
    bus.plug(emulator->device());
    device = std::make_unique<SpaceMouseDevice>(UsbBus().list().at(0));
  }
  bool isLit() {
    return emulator->withFirmware([](const auto& firmware) { return firmware.isLit; });
  }
  /// All reports of a moment, each taken.
  void push(const Counts& counts, std::uint16_t buttons = 0) {
    const std::vector<test::Bytes> reports = emulator->withFirmware([&](SpaceMouseFirmware& firmware) {
      firmware.counts = counts;
      firmware.buttons = buttons;
      return firmware.reports();
    });
    for (const test::Bytes& report : reports)
      send(report);
  }
  void send(const test::Bytes& report) {
    const auto taken = [&] { return device->counters().poses + device->counters().rejected; };
    // What was sent before has been taken when the host has asked again with all that it asks with.
    ASSERT_TRUE(emulator->device()->waitForRequests(0x81, 4));
    const std::uint64_t before = taken();
    ASSERT_NE(emulator->device()->send(0x81, report), test::EmulatedDevice::Sending::NobodyAsked);
    ASSERT_TRUE(test::promptly([&] { return taken() == before + 1; }));
  }
  void expectDeflected(const Counts& counts) {
    const SpaceMouseState& newest = device->newest();
    for (std::size_t axis = 0; axis < 6; ++axis)
      EXPECT_DOUBLE_EQ(newest.axes[axis], kSigns[axis] * counts[axis] / kFullScale) << axis;
  }
  RigidTransform pose() {
    HandleInput handle;
    EXPECT_TRUE(device->readHandle(handle));
    return handle.pose;
  }
  /// Time passes between two looks, and nothing moves.
  bool stands() {
    const RigidTransform before = pose();
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const RigidTransform after = pose();
    return before == after;
  }

  test::EmulatedBus bus;
  std::unique_ptr<test::SpaceMouseEmulator> emulator;
  std::unique_ptr<SpaceMouseDevice> device;
};

TEST_F(SpaceMouseOverUsb, ItsLightShinesAsLongAsItIsOpen) {
  for (const Model model : {Model::Navigator, Model::Pro}) {
    device.reset();
    if (emulator) bus.unplug(*emulator->device());
    use(model);
    EXPECT_FALSE(isLit());
    device->start({});
    EXPECT_TRUE(isLit());
    device->stop();
    EXPECT_FALSE(isLit());
  }
}

TEST_F(SpaceMouseOverUsb, EachAxisDrivesTheHandleItsOwnWayAndNoOther) {
  use(Model::Navigator);
  device->start({});
  for (int axis = 0; axis < 6; ++axis) {
    SCOPED_TRACE(axis);
    const RigidTransform before = pose();
    emulator->stream([&](SpaceMouseFirmware& firmware, double) {
      firmware.counts = {};
      firmware.counts[static_cast<std::size_t>(axis)] = 350;
    });
    const auto moved = [&] {
      const RigidTransform now = pose();
      const glm::dquat turn = now.rotation * glm::conjugate(before.rotation);
      const glm::dvec3 way = now.translation - before.translation;
      return std::array<double, 6>{way.x, way.y, way.z, 2.0 * turn.x, 2.0 * turn.y, 2.0 * turn.z};
    };
    const auto at = static_cast<std::size_t>(axis);
    // A millimetre, or a centiradian.
    const double enough = axis < 3 ? 1e-3 : 1e-2;
    EXPECT_TRUE(eventually([&] { return kSigns[at] * moved()[at] > enough; }));
    emulator->stopStreaming();
    push({});
    const std::array<double, 6> way = moved();
    for (std::size_t other = 0; other < 6; ++other) {
      if (other == at) continue;
      EXPECT_NEAR(way[other], 0.0, 1e-12) << "rounding alone";
    }
  }
}

TEST_F(SpaceMouseOverUsb, ReleasedItStandsAtOnce) {
  use(Model::Navigator);
  device->start({});
  emulator->stream([](SpaceMouseFirmware& firmware, double) { firmware.counts = {350, 0, 0, 0, 350, 0}; });
  ASSERT_TRUE(eventually([&] { return pose().translation.x > 1e-3; }));
  emulator->stopStreaming();
  push({});
  pose();
  for (int i = 0; i < 10; ++i)
    EXPECT_TRUE(stands());
}

TEST_F(SpaceMouseOverUsb, SilenceWhileItsCapIsPushedStopsTheMotion) {
  use(Model::Navigator);
  device->start({});
  const auto push = [&] {
    emulator->stream([](SpaceMouseFirmware& firmware, double) { firmware.counts = {350, 0, 0, 0, 350, 0}; });
  };
  push();
  ASSERT_TRUE(eventually([&] { return pose().translation.x > 1e-3; }));
  // It says no more that its cap is pushed, nor that it is not: the last report of it may have been lost.
  emulator->stopStreaming();
  emulator->device()->hang(true);
  EXPECT_TRUE(eventually([&] { return stands(); }));
  for (int i = 0; i < 10; ++i)
    EXPECT_TRUE(stands());
  EXPECT_EQ(device->state(), DeviceState::Armed) << "silence is what a space mouse has to say while it rests";
  const double before = pose().translation.x;
  emulator->device()->hang(false);
  push();
  EXPECT_TRUE(eventually([&] { return pose().translation.x > before + 1e-3; })) << "it goes on with it";
}

TEST_F(SpaceMouseOverUsb, UnpluggedWhileItsCapIsPushedTheHandleStays) {
  use(Model::Navigator);
  device->start({});
  emulator->stream([](SpaceMouseFirmware& firmware, double) { firmware.counts = {350, 0, 0, 0, 0, 0}; });
  ASSERT_TRUE(eventually([&] { return pose().translation.x > 1e-3; }));
  bus.unplug(*emulator->device(), test::Unplugging::NoDevice);
  ASSERT_TRUE(eventually([&] { return device->state() == DeviceState::Lost; }));
  HandleInput handle;
  handle.pose.translation = {1.0, 2.0, 3.0};
  EXPECT_FALSE(device->readHandle(handle));
  EXPECT_EQ(handle.pose.translation, glm::dvec3(1.0, 2.0, 3.0)) << "left as it was";
}

TEST_F(SpaceMouseOverUsb, EitherModelsReportsAreReadByItsDescriptor) {
  for (const Model model : {Model::Navigator, Model::Pro}) {
    device.reset();
    if (emulator) bus.unplug(*emulator->device());
    use(model);
    device->start({});
    for (int i = 0; i < 200; ++i) {
      Counts counts{};
      for (int axis = 0; axis < 6; ++axis)
        counts[static_cast<std::size_t>(axis)] = static_cast<std::int16_t>((37 * i + 100 * axis) % 701 - 350);
      push(counts, static_cast<std::uint16_t>(i % 4));
      expectDeflected(counts);
      EXPECT_EQ(device->newest().buttons, static_cast<std::uint64_t>(i % 4));
      ASSERT_FALSE(HasFailure()) << i;
    }
    EXPECT_EQ(device->counters().rejected, 0U);
  }
  // The newer one has fifteen buttons.
  push({}, 1U << 14U);
  EXPECT_EQ(device->newest().buttons, std::uint64_t{1} << 14U);
}

TEST_F(SpaceMouseOverUsb, WithoutItsDescriptorEitherLayoutIsKnown) {
  for (const Model model : {Model::Navigator, Model::Pro}) {
    device.reset();
    if (emulator) bus.unplug(*emulator->device());
    emulator = std::make_unique<test::SpaceMouseEmulator>(model);
    emulator->device()->onControl = [](const test::ControlRequest&) { return std::nullopt; };
    bus.plug(emulator->device());
    device = std::make_unique<SpaceMouseDevice>(UsbBus().list().at(0));
    device->start({});
    const Counts counts{350, -100, 70, -350, 35, 1};
    push(counts, 2);
    expectDeflected(counts);
    EXPECT_EQ(device->newest().buttons, 2U);
    EXPECT_EQ(device->counters().rejected, 0U);
  }
}

TEST_F(SpaceMouseOverUsb, AReportOfWhichAxesAreMissingMovesNone) {
  for (const Model model : {Model::Navigator, Model::Pro}) {
    device.reset();
    if (emulator) bus.unplug(*emulator->device());
    use(model);
    device->start({});
    const Counts counts{350, -100, 70, -350, 35, 1};
    push(counts);
    test::Bytes cut = emulator->withFirmware([](SpaceMouseFirmware& firmware) {
      firmware.counts = {-350, -350, -350, -350, -350, -350};
      return firmware.reports().front();
    });
    for (cut.pop_back(); cut.size() > 1; cut.pop_back()) {
      const std::uint64_t before = device->counters().rejected;
      send(cut);
      EXPECT_EQ(device->counters().rejected, before + 1) << cut.size();
    }
    expectDeflected(counts);
  }
}

}  // namespace
}  // namespace nearfit::spacemouse_usb_test
