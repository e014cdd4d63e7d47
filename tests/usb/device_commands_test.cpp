#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/cli/device_monitor.h"
#include "app/cli/device_test.h"
#include "app/cli/devices_text.h"
#include "app/cli/output.h"
#include "app/cli/place_run.h"
#include "app/cli/rate_options.h"
#include "core/base/error.h"
#include "device/openhap/openhap_device.h"
#include "device/spacemouse/spacemouse_device.h"
#include "tests/support/servo_fixtures.h"
#include "tests/support/temporary_folder.h"
#include "tests/usb/emulated_bus.h"
#include "tests/usb/openhap_emulator.h"
#include "tests/usb/spacemouse_firmware.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::device_commands_test {
namespace {

using nlohmann::json;
using test::eventually;
using test::OpenHapFirmware;
using testing::HasSubstr;

/// What a command prints.
template <class Command>
std::string printed(Command&& command) {
  testing::internal::CaptureStdout();
  try {
    command();
  } catch (...) {
    cli::flushOutput();
    testing::internal::GetCapturedStdout();
    throw;
  }
  cli::flushOutput();
  return testing::internal::GetCapturedStdout();
}

std::vector<json> objectsIn(const std::string& text) {
  std::vector<json> objects;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
    objects.push_back(json::parse(text.substr(at, text.find('\n', at) - at)));
  return objects;
}

/// An emulated OpenHap device, as the commands get it.
class OpenHapCommand : public testing::Test {
 protected:
  /// Slow, and lenient towards threads that do not run for a while: timing decides nothing here.
  static openhap::Capabilities lenient() {
    openhap::Capabilities is = test::OpenHapEmulator::usualCapabilities();
    is.rate = 30;
    is.watchdogMs = 10'000;
    return is;
  }
  OpenHapCommand() {
    bus.plug(emulator.device());
    const std::vector<UsbDescription> seen = UsbBus().list();
    SafetyLimits safety;
    safety.patience = {10.0, 10.0};
    device = std::make_unique<OpenHapDevice>(seen.at(0), safety);
  }
  bool isArmed() {
    return emulator.withFirmware([](const OpenHapFirmware& firmware) { return firmware.isArmed(); });
  }
  /// Looks at what the motors are told, at each pose; keeps the most along each axis.
  void streamAndWatch(std::function<void(OpenHapFirmware&, double)> hand = {}) {
    emulator.stream({.hand = [this, hand = std::move(hand)](OpenHapFirmware& firmware, double time) {
      if (hand) hand(firmware, time);
      wasArmed = wasArmed || firmware.isArmed();
      for (std::size_t i = 0; i < 3; ++i)
        most[i] = std::max(most[i], std::abs(firmware.lastWrench().force[i]));
    }});
  }
  json test(bool hasConsent) {
    return json::parse(printed([&] { cli::testDevice(*device, {hasConsent, true}); }));
  }
  static std::string resultOf(const json& result, const std::string& step) {
    for (const json& each : result["steps"]) {
      if (each["name"] == step) return each["result"];
    }
    return "none";
  }

  test::EmulatedBus bus;
  test::OpenHapEmulator emulator{lenient()};
  std::unique_ptr<OpenHapDevice> device;
  // The emulator's thread's, until it is stopped.
  std::array<float, 3> most{};
  bool wasArmed = false;
};

TEST_F(OpenHapCommand, MonitoringShowsWhatTheDeviceSends) {
  streamAndWatch([](OpenHapFirmware& firmware, double) {
    firmware.handle.position = {0.01F, -0.02F, 0.03F};
    firmware.handle.rotation = {0.0F, 1.0F, 0.0F, 0.0F};
    firmware.handle.buttons = 2;
  });
  const std::vector<json> looks = objectsIn(printed([&] { cli::monitorDevice(*device, {1.1, true}); }));
  emulator.stopStreaming();
  ASSERT_FALSE(looks.empty());
  const json& last = looks.back();
  EXPECT_EQ(last["state"], "ready");
  EXPECT_GT(last["reports"], 0);
  // The last look may come right after the one before.
  EXPECT_TRUE(std::any_of(looks.begin(), looks.end(), [](const json& look) { return look["rate"] > 0.0; }));
  EXPECT_EQ(last["rejected"], 0);
  EXPECT_EQ(last["buttons"], 2);
  EXPECT_NEAR(last["pose"][0], 0.01, 1e-8);
  EXPECT_NEAR(last["pose"][2], 0.03, 1e-8);
  EXPECT_DOUBLE_EQ(last["pose"][4], 1.0);
  EXPECT_GT(last["interval_ms"]["p50"], 0.0);
  EXPECT_EQ(last["forces"], "off");
  EXPECT_TRUE(last["force"].is_null()) << "what is not sent is not shown";
  EXPECT_FALSE(wasArmed);
  EXPECT_EQ(device->state(), DeviceState::Present);
}

TEST_F(OpenHapCommand, MonitoringArmedResistsMotionAndShowsWhatItSends) {
  // To and fro along x at a tenth of a metre a second at most: 0.2 N.
  streamAndWatch([](OpenHapFirmware& firmware, double time) {
    firmware.handle.position = {static_cast<float>(0.1 * std::sin(time)), 0.0F, 0.0F};
  });
  cli::MonitorOptions options{3.0, true};
  options.isArming = true;
  const std::vector<json> looks = objectsIn(printed([&] { cli::monitorDevice(*device, options); }));
  emulator.stopStreaming();
  EXPECT_TRUE(wasArmed);
  EXPECT_GT(most[0], 0.0F);
  EXPECT_LE(most[0], 0.5F + 1e-6F);
  EXPECT_EQ(most[1], 0.0F);
  ASSERT_EQ(looks.back()["forces"], "out");
  ASSERT_TRUE(looks.back()["force"].is_array());
  EXPECT_LE(std::abs(looks.back()["force"][0].get<double>()), 0.5);
  EXPECT_FALSE(isArmed());
}

TEST_F(OpenHapCommand, MonitoringEndsWithTheDevice) {
  streamAndWatch();
  std::thread pull([&] {
    eventually([&] { return emulator.withFirmware([](const auto& is) { return is.accepted() > 3; }); });
    emulator.device()->pull(test::Unplugging::NoDevice);
  });
  EXPECT_THROW(printed([&] { cli::monitorDevice(*device, {120.0, true}); }), DeviceError);
  pull.join();
}

TEST_F(OpenHapCommand, ATestWithoutConsentLetsNoForceOut) {
  streamAndWatch();
  const json result = test(false);
  emulator.stopStreaming();
  EXPECT_TRUE(result["passed"]);
  for (const char* step : {"open", "reports", "poses"})
    EXPECT_EQ(resultOf(result, step), "pass") << result;
  EXPECT_EQ(resultOf(result, "forces"), "skip");
  EXPECT_FALSE(wasArmed);
}

TEST_F(OpenHapCommand, ATestWithConsentPushesGentlyAlongEachAxisAndDisarms) {
  streamAndWatch();
  const json result = test(true);
  emulator.stopStreaming();
  EXPECT_TRUE(result["passed"]) << result;
  for (const char* step : {"arm", "push x", "push y", "push z", "disarm"})
    EXPECT_EQ(resultOf(result, step), "pass") << result;
  for (const float force : most) {
    EXPECT_LE(force, 0.5F + 1e-6F);
    EXPECT_GT(force, 0.0F);
  }
  EXPECT_TRUE(wasArmed);
  EXPECT_FALSE(isArmed());
}

TEST_F(OpenHapCommand, AHandleThatRunsAwayEndsTheTestWithoutForce) {
  // It gives way by a metre for a newton: far more than a hand.
  streamAndWatch([](OpenHapFirmware& firmware, double) {
    firmware.handle.position = firmware.isArmed() ? firmware.lastWrench().force : std::array<float, 3>{};
  });
  try {
    printed([&] { cli::testDevice(*device, {true, true}); });
    ADD_FAILURE() << "it passed";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("1 of "));
  }
  emulator.stopStreaming();
  EXPECT_FALSE(isArmed());
  EXPECT_GT(most[0], 0.0F) << "pushed it was";
  EXPECT_EQ(most[1], 0.0F) << "and was pushed no more";
  EXPECT_EQ(most[2], 0.0F);
  EXPECT_EQ(device->state(), DeviceState::Present);
}

TEST_F(OpenHapCommand, ATestOfAFaultyDeviceDoesNotArmIt) {
  emulator.withFirmware([](OpenHapFirmware& firmware) { firmware.fault = "motor too hot"; });
  streamAndWatch();
  EXPECT_THROW(printed([&] { cli::testDevice(*device, {true, true}); }), Error);
  emulator.stopStreaming();
  EXPECT_FALSE(wasArmed);
}

/// The cone over the floor, its tip at 0.04 m: led by the device.
class OpenHapPlaces : public OpenHapCommand {
 protected:
  /// Longer than anything is waited for [s].
  static constexpr double kEndless = 120.0;

  cli::PlaceJob job(bool isArming, double seconds) {
    auto scene = test::coneOverFloor();
    const PartGeometryPtr cone = scene->moving.geometry;
    scene->setMoving({PartId{2}, cone, test::tipAt(0.04)});
    cli::PlaceJob is;
    is.scene = std::move(scene);
    is.parameters.haptics.mode = HapticMode::Springs;
    is.parameters.haptics.springs = {
        .cutoff = 0.1, .stiffness = 50.0, .damping = 0.0, .law = SpringLaw::Linear};
    is.device = std::move(device);
    is.seconds = seconds;
    is.isArming = isArming;
    return is;
  }
};

TEST_F(OpenHapPlaces, PosesComeInAndWrenchesGoOut) {
  // Wherever its frame begins; then down by a centimetre.
  streamAndWatch([](OpenHapFirmware& firmware, double) {
    const bool isFelt = firmware.isArmed() && firmware.lastWrench().force[2] > 0.0F;
    firmware.handle.position = {0.02F, 0.01F, isFelt ? 0.02F : 0.03F};
  });
  const double felt = 50.0 * (0.1 - 0.03);
  // As the user does, with Ctrl+C, once it is felt in full.
  std::thread user([&] {
    if (eventually([&] { return emulator.withFirmware([&](auto&) { return most[2] > felt - 5e-6; }); }))
      std::raise(SIGINT);
  });
  const cli::PlaceResult result = cli::placeWithDevice(job(true, kEndless));
  user.join();
  emulator.stopStreaming();
  ASSERT_TRUE(result.device);
  EXPECT_EQ(result.device->trouble, "");
  EXPECT_TRUE(result.device->wasArmed);
  EXPECT_GT(result.device->counters.poses, 0U);
  EXPECT_EQ(result.device->counters.rejected, 0U);
  EXPECT_GT(result.device->roundTrip.count(), 0U);
  EXPECT_GT(result.device->roundTrip.percentile(0.5), 0.0);
  EXPECT_DOUBLE_EQ(result.device->limits.maxForce, 8.0);
  EXPECT_NEAR(result.end.translation.z, 0.03, 1e-6);
  EXPECT_NEAR(result.force.value, felt, 1e-5);
  EXPECT_NEAR(most[2], felt, 1e-5);
  EXPECT_FALSE(isArmed());
}

TEST_F(OpenHapPlaces, WithoutArmingNoForceGoesOut) {
  streamAndWatch();
  const cli::PlaceResult result = cli::placeWithDevice(job(false, 1.0));
  emulator.stopStreaming();
  EXPECT_FALSE(result.device->wasArmed);
  EXPECT_FALSE(wasArmed);
  EXPECT_EQ(most[2], 0.0F);
  EXPECT_GT(result.ticks, 0U);
}

TEST_F(OpenHapPlaces, ADeviceThatIsPulledOutEndsItWithTheReasonAndTheRecordWhole) {
  streamAndWatch();
  const test::TemporaryFolder folder;
  MotionWriter writer(folder.path() / "felt.csv");
  cli::PlaceJob led = job(true, kEndless);
  led.writer = &writer;
  std::thread pull([&] {
    // A wrench has come, so that there was a tick.
    eventually(
        [&] { return isArmed() && emulator.withFirmware([](const auto& is) { return is.accepted() > 0; }); });
    emulator.device()->pull(test::Unplugging::Shutdown);
  });
  const cli::PlaceResult result = cli::placeWithDevice(std::move(led));
  pull.join();
  writer.finish();
  EXPECT_NE(result.device->trouble, "");
  EXPECT_GT(result.ticks, 0U);
  EXPECT_EQ(result.lostRows, 0U);
  const std::string rows = test::readBytes(folder.path() / "felt.csv");
  EXPECT_EQ(static_cast<std::uint64_t>(std::count(rows.begin(), rows.end(), '\n')), result.ticks + 1);
}

/// A space mouse whose cap is pushed to the right.
class SpaceMouseCommand : public testing::Test {
 protected:
  SpaceMouseCommand() {
    firmware.counts = {350, 0, 0, 0, 0, 0};
    firmware.buttons = 4;
    test::EmulatedDescription description;
    description.vendor = 0x046d;
    description.product = 0xc626;
    description.productName = "SpaceNavigator";
    description.interfaces = {{.classCode = 3, .endpoints = {{.address = 0x81}}, .kernelDriver = "usbhid"}};
    mouse = std::make_shared<test::EmulatedDevice>(description);
    mouse->onControl = [this](const test::ControlRequest& request) {
      return firmware.onRequest(request.type, request.request, request.value,
                                {request.data.begin(), request.data.end()});
    };
    bus.plug(mouse);
    device = std::make_unique<SpaceMouseDevice>(UsbBus().list().at(0));
    const std::vector<test::Bytes> reports = firmware.reports();
    pushing.emplace(*mouse, test::ReportStream::Plan{
                                .rate = 375.0,
                                .report = [reports](std::uint64_t n) { return reports[n % reports.size()]; },
                                .isPatient = true});
  }

  test::EmulatedBus bus;
  test::SpaceMouseFirmware firmware{test::SpaceMouseFirmware::Model::Navigator};
  std::shared_ptr<test::EmulatedDevice> mouse;
  std::optional<test::ReportStream> pushing;
  std::unique_ptr<SpaceMouseDevice> device;
};

TEST_F(SpaceMouseCommand, MonitoringShowsItDriving) {
  const std::vector<json> looks = objectsIn(printed([&] { cli::monitorDevice(*device, {1.1, true}); }));
  pushing->stop();
  const json& last = looks.back();
  EXPECT_GT(last["reports"], 0);
  EXPECT_EQ(last["buttons"], 4);
  EXPECT_GT(last["pose"][0], 0.0);
  EXPECT_DOUBLE_EQ(last["pose"][1], 0.0);
}

TEST_F(SpaceMouseCommand, OptionsChangeWhereItDrives) {
  cli::RateOptions options;
  options.axes = "-x,y";
  options.fullSpeed = 0.02;
  cli::applyRateOptions(options, *device);
  const std::vector<json> looks = objectsIn(printed([&] { cli::monitorDevice(*device, {1.1, true}); }));
  pushing->stop();
  const json& last = looks.back();
  EXPECT_LT(last["pose"][0], 0.0);
  EXPECT_GE(last["pose"][0], -0.02 * last["t_s"].get<double>());
  EXPECT_EQ(last["forces"], "none");
}

TEST_F(SpaceMouseCommand, ArmingWhatDoesNotPushIsRefused) {
  cli::MonitorOptions options{0.1, true};
  options.isArming = true;
  EXPECT_THROW(printed([&] { cli::monitorDevice(*device, options); }), UsageError);
  pushing->stop();
}

TEST_F(SpaceMouseCommand, TheFirstButtonHoldsThePartAndTheSecondLetsGoOnce) {
  device->start({});
  const auto press = [&](std::uint16_t buttons) {
    pushing->stop();
    firmware.buttons = buttons;
    const std::vector<test::Bytes> reports = firmware.reports();
    for (const test::Bytes& report : reports)
      mouse->send(0x81, report);
    HandleInput handle;
    EXPECT_TRUE(test::eventually([&] { return device->readHandle(handle) && handle.buttons == buttons; }));
    return handle;
  };
  const HandleInput held = press(1);
  EXPECT_TRUE(held.isClutched);
  EXPECT_FALSE(held.returnsToPart);
  HandleInput next;
  ASSERT_TRUE(device->readHandle(next));
  EXPECT_EQ(next.pose.translation, held.pose.translation) << "the cap is pushed, and nothing moves";
  const HandleInput back = press(2);
  EXPECT_FALSE(back.isClutched);
  EXPECT_TRUE(back.returnsToPart);
  ASSERT_TRUE(device->readHandle(next));
  EXPECT_FALSE(next.returnsToPart) << "once each time that it is pressed";
}

TEST_F(SpaceMouseCommand, ATestFindsNothingToPushWith) {
  const json result = json::parse(printed([&] { cli::testDevice(*device, {true, true}); }));
  pushing->stop();
  EXPECT_TRUE(result["passed"]) << result;
  EXPECT_EQ(result["steps"].back()["name"], "forces");
  EXPECT_EQ(result["steps"].back()["result"], "skip");
}

TEST_F(SpaceMouseCommand, WhatIsForbiddenIsToldWithTheCommandThatMendsIt) {
  pushing->stop();
  mouse->denyPermission(true);
  std::vector<std::string> problems;
  const std::vector<DeviceListing> devices = listDevices(UsbBus(), {}, problems);
  const std::string text = cli::devicesText(devices);
  EXPECT_THAT(text, HasSubstr("SpaceNavigator"));
  EXPECT_THAT(text, HasSubstr("cannot be used: you have no permission to open it; run: sudo cp "));
  EXPECT_THAT(text, HasSubstr("70-nearfit.rules' /etc/udev/rules.d/ && sudo udevadm control --reload && "
                              "sudo udevadm trigger\n"));
  const json listed = json::parse(cli::devicesJson(devices));
  EXPECT_EQ(listed["devices"][0]["problem"], "no_permission");
}

}  // namespace
}  // namespace nearfit::device_commands_test
