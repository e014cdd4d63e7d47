#include <cmath>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "device/polhem/polhem_device.h"
#include "tests/usb/driver_bench.h"
#include "tests/usb/polhem_emulator.h"
#include "tests/usb/usb_fixture.h"

namespace nearfit::test {
namespace {

/// Of 32,000 counts a turn: 28 degrees to either side, of 100.
constexpr int kMaxJointCounts = 2500;
/// Where it is switched on, which is its rest.
constexpr std::array<std::int16_t, 6> kRest{1000, -200, 30, 0, 0, 0};

std::array<std::int16_t, 6> jointCountsAt(int i) {
  std::array<std::int16_t, 6> counts = kRest;
  const int turned = toAndFro(i, kMaxJointCounts);
  counts[0] = static_cast<std::int16_t>(counts[0] + turned);
  counts[1] = static_cast<std::int16_t>(counts[1] + turned / 2);
  counts[2] = static_cast<std::int16_t>(counts[2] - turned / 2);
  return counts;
}

class PolhemBench final : public DriverBench {
 public:
  /// Its reports have no checksum: one that says something else in the right size is a pose that it may not
  /// have, which polhem_usb_test.cpp sees to.
  Traits traits() const override {
    // There is nothing that opening it asks for.
    return {.driver = DeviceDriver::Polhem,
            .opened = DeviceState::Uncalibrated,
            .whenSilent = std::nullopt,
            .whenRefusing = std::nullopt};
  }
  const std::shared_ptr<EmulatedDevice>& emulated() const override { return emulator_.device(); }
  std::unique_ptr<HapticDevice> make(const UsbDescription& seen, const SafetyLimits& safety) override {
    return std::make_unique<PolhemDevice>(seen, calibration_, safety);
  }

  void start(HapticDevice& device) override {
    device.start({});
    // It was sent a command to set it going: the answer to that is the first report.
    stream();
    HandleInput handle;
    ASSERT_TRUE(takeReport(device, handle));
  }
  void makeWell(HapticDevice& device) override {
    HandleInput handle;
    hold(0);
    ASSERT_TRUE(round(device, {}, handle));
    device.calibrate();
    ASSERT_TRUE(round(device, {}, handle));
    ASSERT_EQ(device.state(), DeviceState::Ready);
  }
  void hold(int i) override {
    const std::array<std::int16_t, 6> counts = jointCountsAt(i);
    emulator_.withFirmware([&](PolhemFirmware& firmware) {
      firmware.counts = {counts[0], counts[1], counts[2], counts[3], counts[4], counts[5]};
    });
  }
  void expectHeld(HapticDevice&, const HandleInput& handle, int i) override {
    EXPECT_EQ(handle.pose.translation,
              kinematics_.positionOf(kinematics_.anglesOf(jointCountsAt(i), kRest).arm));
  }
  bool round(HapticDevice& device, const Wrench& wrench, HandleInput& handle) override {
    device.sendWrench(wrench);
    return takeReport(device, handle);
  }

  /// It answers commands, as it may have done since it was started.
  void stream() override {
    if (!std::exchange(isStreaming_, true)) emulator_.stream();
  }
  void stopStreaming() override {
    emulator_.stopStreaming();
    isStreaming_ = false;
  }
  void powerOff() override {
    stopStreaming();
    emulator_.powerOff();
  }

  std::vector<BadReport> badReports() const override {
    return {{"empty", [](Bytes& bytes) { bytes.clear(); }},
            {"cut short", [](Bytes& bytes) { bytes.pop_back(); }},
            {"too long", [](Bytes& bytes) { bytes.push_back(std::byte{0}); }},
            {"of another board", [](Bytes& bytes) { bytes.resize(64); }},
            {"oversized", [](Bytes& bytes) { bytes.resize(100); }, true}};
  }
  void sendBad(HapticDevice& device, const BadReport& bad) override {
    const std::uint64_t before = commands();
    emulator_.damageNext(bad.damage);
    device.sendWrench({});
    EXPECT_TRUE(promptly([&] { return commands() == before + 1; }));
  }

  std::uint64_t commands() override {
    return emulator_.withFirmware([](const auto& firmware) { return firmware.accepted(); });
  }
  bool isPushing() override { return told() != std::array<int, 3>{}; }
  void holdAt(const glm::dvec3& offset) override {
    const polhem::Angles rest = kinematics_.restAngles();
    const auto arm = kinematics_.armFor(kinematics_.positionOf(rest.arm) + offset);
    ASSERT_TRUE(arm);
    at_ = *arm;
    emulator_.withFirmware([&](PolhemFirmware& firmware) {
      for (int i = 0; i < 3; ++i) {
        const auto joint = static_cast<std::size_t>(i);
        const polhem::Joint& is = calibration_.joints[joint].joint;
        const double turns = (at_[i] - rest.arm[i]) / (2.0 * std::numbers::pi);
        firmware.counts[joint] =
            kRest[joint] + static_cast<int>(std::lround(turns * is.countsPerTurn * is.gearRatio));
      }
    });
  }
  glm::dvec3 force() override {
    const std::array<int, 3> given = told();
    return forceFor({given[0], given[1], given[2]}, [&](const glm::dvec3& force) {
      const std::array<int, 3> asked = kinematics_.milliampsFor(force, at_);
      return glm::dvec3(asked[0], asked[1], asked[2]);
    });
  }
  void expectTold(const Wrench& wrench, const HandleInput& handle) override {
    const auto arm = kinematics_.armFor(handle.pose.translation);
    ASSERT_TRUE(arm);
    const std::array<int, 3> asked = kinematics_.milliampsFor(wrench.force, *arm), given = told();
    for (std::size_t i = 0; i < given.size(); ++i)
      EXPECT_NEAR(given[i], asked[i], 1) << "the inverse's rounding, cut to whole numbers";
    EXPECT_EQ(emulator_.withFirmware([](const auto& firmware) { return firmware.ignored(); }), 0U);
  }

 private:
  std::array<int, 3> told() {
    return emulator_.withFirmware([](const auto& firmware) { return firmware.told(); });
  }

  const polhem::Calibration calibration_;
  const polhem::Kinematics kinematics_{calibration_};
  PolhemEmulator emulator_;
  bool isStreaming_ = false;
  glm::dvec3 at_ = kinematics_.restAngles().arm;  ///< Angles of the arm, by holdAt().
};

}  // namespace

std::unique_ptr<DriverBench> polhemBench() {
  return std::make_unique<PolhemBench>();
}

}  // namespace nearfit::test
