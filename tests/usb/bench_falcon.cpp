#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "device/falcon/falcon_device.h"
#include "device/falcon/falcon_kinematics.h"
#include "tests/support/temporary_folder.h"
#include "tests/usb/driver_bench.h"
#include "tests/usb/falcon_emulator.h"

namespace nearfit::test {
namespace {

/// Some blocks and a part of one.
const std::string kImage(1000, 'f');
/// Of 0.036 degrees of a thigh each.
constexpr int kMaxThighCounts = 250;
/// Far less than a count, which is 40 um; far more than what Newton's method leaves [m].
constexpr double kSlack = 1e-6;

std::array<std::int16_t, 3> encodersAt(int i) {
  const auto count = static_cast<std::int16_t>(toAndFro(i, kMaxThighCounts));
  return {count, 0, static_cast<std::int16_t>(-count)};
}

class FalconBench final : public DriverBench {
 public:
  /// Its frames have no checksum; what is damaged shows as letters that are none, or as places where its
  /// thighs cannot be (falcon_usb_test.cpp). It is a line of bytes: an empty report is none at all.
  Traits traits() const override {
    return {.driver = DeviceDriver::Falcon,
            .opened = DeviceState::Uncalibrated,
            .whenSilent = DeviceProblem::NotAnswering,
            .whenRefusing = DeviceProblem::NotAnswering,
            .out = 0x02};
  }
  const std::shared_ptr<EmulatedDevice>& emulated() const override { return emulator_.device(); }
  std::unique_ptr<HapticDevice> make(const UsbDescription& seen, const SafetyLimits& safety) override {
    return std::make_unique<FalconDevice>(seen, file_, safety);
  }

  void start(HapticDevice& device) override {
    device.start({});
    // It was sent a command to set it going: the answer to that is the first report.
    HandleInput handle;
    ASSERT_TRUE(takeReport(device, handle));
  }
  /// Its handle is moved out and in, past the indexes.
  void makeWell(HapticDevice& device) override {
    HandleInput handle;
    emulator_.withFirmware([](FalconFirmware& firmware) { firmware.indexesPassed = 7; });
    for (int i = 0; i < 3; ++i)
      ASSERT_TRUE(round(device, {}, handle));
    ASSERT_EQ(device.state(), DeviceState::Ready);
  }
  void hold(int i) override {
    emulator_.withFirmware([&](FalconFirmware& firmware) { firmware.encoders = encodersAt(i); });
  }
  void expectHeld(HapticDevice&, const HandleInput& handle, int i) override {
    const auto place = falcon::forward(falcon::anglesOf(encodersAt(i)), falcon::kCentre);
    ASSERT_TRUE(place);
    EXPECT_LT(glm::distance(handle.pose.translation, *place), kSlack);
  }
  bool round(HapticDevice& device, const Wrench& wrench, HandleInput& handle) override {
    device.sendWrench(wrench);
    return takeReport(device, handle);
  }

  /// It answers commands, and its chip says all the time that there is nothing to say.
  void stream() override {}
  void stopStreaming() override {}
  void powerOff() override {
    emulator_.withFirmware([](FalconFirmware& firmware) { firmware.powerOff(); });
  }

  std::vector<BadReport> badReports() const override {
    return {{"cut short", [](Bytes& bytes) { bytes.erase(bytes.begin() + 5, bytes.end() - 1); }},
            {"too long", [](Bytes& bytes) { bytes.insert(bytes.begin() + 5, 6, std::byte{'A'}); }},
            {"garbage", [](Bytes& bytes) { std::fill(bytes.begin() + 1, bytes.end() - 1, std::byte{'z'}); }},
            {"oversized", [](Bytes& bytes) { bytes.resize(100); }, true}};
  }
  void sendBad(HapticDevice& device, const BadReport& bad) override {
    if (bad.isOversized) {
      // Its bytes are cut into packets, however many they are: a packet itself is too long here.
      Bytes packet;
      bad.damage(packet);
      emulated()->send(traits().in, packet);
      return;
    }
    emulator_.withFirmware([&](FalconFirmware& firmware) { firmware.damageNext = bad.damage; });
    const std::uint64_t before = commands();
    device.sendWrench({});
    EXPECT_TRUE(promptly([&] { return commands() == before + 1; }));
  }

  std::uint64_t commands() override {
    return emulator_.withFirmware([](const FalconFirmware& firmware) { return firmware.commands(); });
  }
  bool isPushing() override { return told() != std::array<std::int16_t, 3>{}; }
  void holdAt(const glm::dvec3& offset) override {
    at_ = falcon::kCentre + offset;
    const auto thighs = falcon::inverse(at_);
    ASSERT_TRUE(thighs);
    // Four counts a slot of the motor's wheel.
    const double countsPerRadian =
        4.0 * falcon::geometry::kSlots * falcon::geometry::kGearRatio / (2.0 * std::numbers::pi);
    emulator_.withFirmware([&](FalconFirmware& firmware) {
      for (int i = 0; i < 3; ++i) {
        const double angle = (*thighs)[i] - glm::radians(falcon::geometry::kAngleAtIndex);
        firmware.encoders[static_cast<std::size_t>(i)] =
            static_cast<std::int16_t>(std::lround(angle * countsPerRadian));
      }
    });
  }
  glm::dvec3 force() override {
    const auto given = told();
    return forceFor({given[0], given[1], given[2]}, [&](const glm::dvec3& force) {
      const auto asked = falcon::unitsFor(force, at_, falcon::inverse(at_).value_or(glm::dvec3(0.0)));
      return glm::dvec3(asked[0], asked[1], asked[2]);
    });
  }
  void expectTold(const Wrench& wrench, const HandleInput& handle) override {
    const glm::dvec3 place = handle.pose.translation;
    const auto thighs = falcon::inverse(place);
    ASSERT_TRUE(thighs);
    const auto asked = falcon::unitsFor(wrench.force, place, *thighs), given = told();
    for (std::size_t i = 0; i < given.size(); ++i)
      EXPECT_NEAR(given[i], asked[i], 1) << "the inverse's rounding, cut to whole numbers";
  }

 private:
  std::array<std::int16_t, 3> told() {
    return emulator_.withFirmware([](const FalconFirmware& firmware) { return firmware.torques(); });
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.write("firmware.bin", kImage);
  glm::dvec3 at_ = falcon::kCentre;  ///< By holdAt().
  FalconEmulator emulator_{bytesOf(std::as_bytes(std::span(kImage)))};
};

}  // namespace

std::unique_ptr<DriverBench> falconBench() {
  return std::make_unique<FalconBench>();
}

}  // namespace nearfit::test
