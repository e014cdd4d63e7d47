#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "device/openhap/openhap_device.h"
#include "device/servo/servo_loop.h"
#include "tests/support/servo_fixtures.h"
#include "tests/usb/openhap_emulator.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::openhap_servo_test {
namespace {

using test::eventually;

/// The tip of a cone begins this far over the floor, and is then held lower [m].
constexpr double kStartHeight = 0.12, kFeltHeight = 0.04;

ServoParameters softSprings() {
  ServoParameters p;
  p.haptics.mode = HapticMode::Springs;
  p.haptics.springs = {.cutoff = 0.1, .stiffness = 50.0, .damping = 0.0, .law = SpringLaw::Linear};
  p.limits = {100.0, 100.0};
  return p;
}

std::unique_ptr<ServoScene> coneAboveFloor() {
  auto scene = test::coneOverFloor();
  auto moving = scene->moving;
  moving.worldFromPart = test::tipAt(kStartHeight);
  scene->setMoving(moving);
  return scene;
}

TEST(OpenHapServo, FollowsTheDevicesReportsAndItFeelsTheScene) {
  constexpr std::uint64_t kCount = 5000;
  // On a loaded machine a thread may not run for a while: neither side stops for that.
  openhap::Capabilities capabilities = test::OpenHapEmulator::usualCapabilities();
  capabilities.watchdogMs = 10'000;
  SafetyLimits safety;
  safety.patience = {10.0, 10.0};
  test::EmulatedBus bus;
  test::OpenHapEmulator emulator(capabilities);
  bus.plug(emulator.device());
  OpenHapDevice device(UsbBus().list().at(0), safety);
  ServoLoop loop;
  loop.start(device, coneAboveFloor(), softSprings());
  device.arm();
  // From wherever the handle happens to be, down over a thousand wrenches, then held.
  emulator.stream({.hand =
                       [](test::OpenHapFirmware& firmware, double) {
                         const double answered = static_cast<double>(firmware.accepted());
                         const double share = std::clamp((answered - 100.0) / 1000.0, 0.0, 1.0);
                         const double way = (kStartHeight - kFeltHeight) * share;
                         firmware.handle.position = {0.05F, 0.0F, static_cast<float>(0.03 - way)};
                       },
                   .waitsForAnswers = true});
  while (device.counters().poses < kCount && loop.isRunning())
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(device.state(), DeviceState::Armed);
  // 50 N/m over what the tip is inside the cutoff of 0.1 m; floats' places, and the filters' rest.
  const double expected = 50.0 * (0.1 - kFeltHeight);
  EXPECT_TRUE(eventually([&] { return std::abs(emulator.rendered().force[2] - expected) < 1e-3; }))
      << emulator.rendered().force[2];
  emulator.stopStreaming();
  EXPECT_EQ(emulator.counts().lost, 0U);
  // The last may be on its way still.
  EXPECT_TRUE(eventually([&] { return device.counters().poses == emulator.counts().sent; }));
  EXPECT_EQ(device.counters().missing, 0U);
  EXPECT_EQ(device.counters().rejected, 0U);
  loop.stop();
  const LatencyHistogram roundTrips = emulator.roundTrips();
  EXPECT_GE(roundTrips.count() + 1, emulator.counts().sent) << "each is answered before the next";
  std::printf(
      "round trip: p50 %.0f us, p99 %.0f us, p99.9 %.0f us, max %.0f us (%s); waited for a transfer: "
      "%llu, for an answer: %llu of %llu\n",
      1e6 * roundTrips.percentile(0.5), 1e6 * roundTrips.percentile(0.99), 1e6 * roundTrips.percentile(0.999),
      1e6 * roundTrips.max(), loop.schedulingNote().c_str(),
      static_cast<unsigned long long>(emulator.counts().waited),
      static_cast<unsigned long long>(emulator.counts().delayed),
      static_cast<unsigned long long>(emulator.counts().sent));
}

}  // namespace
}  // namespace nearfit::openhap_servo_test
