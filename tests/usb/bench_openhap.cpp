#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "device/openhap/openhap_device.h"
#include "tests/usb/driver_bench.h"
#include "tests/usb/openhap_emulator.h"

namespace nearfit::test {
namespace {

constexpr double kStep = 1e-5;  ///< Of the handle, from place to place [m].
/// As far as it goes to and fro: 5 cm, the workspace's half.
constexpr int kMaxSteps = 2500;

openhap::Capabilities lenient() {
  openhap::Capabilities is = OpenHapEmulator::usualCapabilities();
  is.watchdogMs = 60'000;
  return is;
}

/// A pose that is none, with the right checksum.
void putNoNumber(Bytes& bytes) {
  constexpr std::size_t kPositionAt = 8, kChecksumSize = 2;
  const float no = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + kPositionAt, &no, sizeof no);
  const std::size_t end = bytes.size() - kChecksumSize;
  const std::uint16_t crc = openhap::crc16(std::span(bytes).first(end));
  bytes[end] = static_cast<std::byte>(crc & 0xffU);
  bytes[end + 1] = static_cast<std::byte>(crc >> 8U);
}

class OpenHapBench final : public DriverBench {
 public:
  Traits traits() const override {
    return {.driver = DeviceDriver::OpenHap,
            .whenSilent = DeviceProblem::NotAnswering,
            .whenRefusing = DeviceProblem::NotAnswering};
  }
  const std::shared_ptr<EmulatedDevice>& emulated() const override { return emulator_.device(); }
  std::unique_ptr<HapticDevice> make(const UsbDescription& seen, const SafetyLimits& safety) override {
    return std::make_unique<OpenHapDevice>(seen, safety);
  }

  void start(HapticDevice& device) override { device.start({}); }
  void hold(int i) override {
    emulator_.withFirmware([&](OpenHapFirmware& firmware) {
      firmware.handle.position = {static_cast<float>(kStep * toAndFro(i, kMaxSteps)), 0.02F, -0.03F};
    });
  }
  void expectHeld(HapticDevice&, const HandleInput& handle, int i) override {
    EXPECT_EQ(handle.pose.translation,
              glm::dvec3(static_cast<float>(kStep * toAndFro(i, kMaxSteps)), 0.02F, -0.03F));
  }
  bool round(HapticDevice& device, const Wrench& wrench, HandleInput& handle) override {
    const std::uint64_t before = commands();
    const auto sending = emulated()->send(traits().in, emulator_.nextPose());
    if (sending != EmulatedDevice::Sending::Taken && sending != EmulatedDevice::Sending::HadToWait)
      return false;
    if (!takeReport(device, handle)) return false;
    device.sendWrench(wrench);
    return promptly([&] { return commands() == before + 1; });
  }

  void stream() override { emulator_.stream(); }
  void stopStreaming() override { emulator_.stopStreaming(); }
  void powerOff() override {
    stopStreaming();
    emulator_.withFirmware([](OpenHapFirmware& firmware) { firmware.onDisconnected(); });
  }

  std::vector<BadReport> badReports() const override {
    return {{"empty", [](Bytes& bytes) { bytes.clear(); }},
            {"cut short", [](Bytes& bytes) { bytes.pop_back(); }},
            {"oversized", [](Bytes& bytes) { bytes.resize(100); }, true},
            {"wrong checksum", [](Bytes& bytes) { bytes[63] ^= std::byte{0x80}; }},
            {"damaged", [](Bytes& bytes) { bytes[10] ^= std::byte{1}; }},
            {"no number", &putNoNumber},
            {"garbage", [](Bytes& bytes) { bytes.assign(bytes.size(), std::byte{0xa5}); }}};
  }
  void sendBad(HapticDevice&, const BadReport& bad) override {
    Bytes bytes = emulator_.nextPose();
    bad.damage(bytes);
    emulated()->send(traits().in, bytes);
  }

  std::uint64_t commands() override {
    return emulator_.withFirmware([](const auto& firmware) { return firmware.accepted(); });
  }
  bool isPushing() override {
    return emulator_.withFirmware([](const OpenHapFirmware& firmware) {
      const openhap::WrenchReport& told = firmware.lastWrench();
      return firmware.isArmed() && (told.flags & openhap::kForcesOn) != 0 &&
             told.force != std::array<float, 3>{};
    });
  }
  void holdAt(const glm::dvec3& offset) override {
    emulator_.withFirmware([&](OpenHapFirmware& firmware) {
      for (int i = 0; i < 3; ++i)
        firmware.handle.position[static_cast<std::size_t>(i)] = static_cast<float>(offset[i]);
    });
  }
  glm::dvec3 force() override {
    const auto told =
        emulator_.withFirmware([](const OpenHapFirmware& firmware) { return firmware.lastWrench().force; });
    return {told[0], told[1], told[2]};
  }
  void expectTold(const Wrench& wrench, const HandleInput&) override {
    const auto told =
        emulator_.withFirmware([](const OpenHapFirmware& firmware) { return firmware.lastWrench(); });
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      EXPECT_EQ(told.force[axis], static_cast<float>(wrench.force[i]));
      EXPECT_EQ(told.torque[axis], static_cast<float>(wrench.torque[i]));
    }
  }

 private:
  OpenHapEmulator emulator_{lenient()};
};

}  // namespace

std::unique_ptr<DriverBench> openHapBench() {
  return std::make_unique<OpenHapBench>();
}

}  // namespace nearfit::test
