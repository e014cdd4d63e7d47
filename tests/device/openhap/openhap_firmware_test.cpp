#include "tests/usb/openhap_firmware.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace nearfit::test::openhap_firmware_test {
namespace {

using openhap::Request;

/// The reference of what a device must do (resources/docs/openhap.md), by its own clock.
class OpenHapReference : public ::testing::Test {
 protected:
  static openhap::Capabilities capabilities() {
    openhap::Capabilities is;
    is.hasDeadMan = true;
    is.watchdogMs = 50;
    is.maxForce = 8.0F;
    return is;
  }
  OpenHapReference() {
    firmware.isDeadManHeld = true;
    ask(Request::Arm);
  }
  bool ask(Request request) {
    return firmware.onRequest(openhap::kRequestOut, static_cast<std::uint8_t>(request)).has_value();
  }
  /// A wrench along x, and its time to live.
  void wrench(float force, std::uint16_t timeToLiveMs = 20) {
    openhap::WrenchReport report;
    report.flags = openhap::kForcesOn;
    report.force = {force, 0.0F, 0.0F};
    report.timeToLiveMs = timeToLiveMs;
    firmware.onPacket(encode(report), time);
  }
  /// A control loop of 10 kHz; the most that the force changed in one of its steps.
  float pass(double seconds) {
    float most = 0.0F;
    for (const double end = time + seconds; time < end - 1e-9;) {
      const float before = force();
      firmware.onTime(time += 1e-4);
      most = std::max(most, std::abs(force() - before));
    }
    return most;
  }
  float force() const { return firmware.rendered().force[0]; }
  /// Held with four newtons, in full.
  void push() {
    wrench(4.0F);
    pass(5e-3);
    ASSERT_FLOAT_EQ(force(), 4.0F);
  }

  OpenHapFirmware firmware{capabilities()};
  double time = 0.0;
};

TEST_F(OpenHapReference, AForceBeginsNoSoonerThanInAMillisecondAndIsThereAfterFive) {
  wrench(4.0F);
  EXPECT_EQ(force(), 0.0F);
  pass(0.9e-3);
  EXPECT_GT(force(), 0.0F);
  EXPECT_LT(force(), 4.0F);
  pass(4.1e-3);
  EXPECT_FLOAT_EQ(force(), 4.0F);
}

TEST_F(OpenHapReference, ItEndsLikewiseForWhateverReason) {
  const std::array<std::function<void()>, 5> ends = {
      [&] { ask(Request::Disarm); }, [&] { firmware.isDeadManHeld = false; },
      [&] { firmware.fault = "too hot"; }, [&] { firmware.onDisconnected(); },
      [&] {
        openhap::WrenchReport none;
        none.timeToLiveMs = 20;
        firmware.onPacket(encode(none), time);
      }};
  for (const auto& end : ends) {
    push();
    end();
    // Within a millisecond a step of a tenth takes a tenth of it at most.
    EXPECT_LE(pass(0.9e-3), 0.1F * 4.0F + 1e-6F);
    EXPECT_GT(force(), 0.0F);
    pass(4.1e-3);
    EXPECT_EQ(force(), 0.0F);
    firmware.isDeadManHeld = true;
    firmware.fault.clear();
    ask(Request::Arm);
  }
}

TEST_F(OpenHapReference, AWrenchThatHasOutlivedItsTimeFadesBeforeTheWatchdogTrips) {
  push();
  pass(20e-3);
  EXPECT_EQ(force(), 0.0F);
  EXPECT_TRUE(firmware.isArmed());
  pass(30e-3);
  EXPECT_FALSE(firmware.isArmed());
  EXPECT_TRUE(firmware.isWatchdogTripped());
  EXPECT_FALSE(ask(Request::Arm)) << "only Disarm clears it";
  EXPECT_TRUE(ask(Request::Disarm));
  EXPECT_TRUE(ask(Request::Arm));
  pass(10e-3);
  EXPECT_EQ(force(), 0.0F) << "what was asked for before is forgotten";
}

TEST_F(OpenHapReference, MoreThanItCanBearIsMadeLess) {
  wrench(100.0F);
  pass(5e-3);
  EXPECT_FLOAT_EQ(force(), 8.0F);
}

}  // namespace
}  // namespace nearfit::test::openhap_firmware_test
