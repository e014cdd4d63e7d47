#include <gtest/gtest.h>

#include "device/spacemouse/spacemouse_device.h"
#include "tests/usb/driver_bench.h"
#include "tests/usb/spacemouse_emulator.h"

namespace nearfit::test {
namespace {

constexpr std::array<double, 6> kSigns = {1.0, -1.0, -1.0, 1.0, -1.0, -1.0};
constexpr double kFullScale = 350.0;

/// Pushed another way at each place, all over the range.
std::array<std::int16_t, 6> countsAt(int i) {
  std::array<std::int16_t, 6> counts{};
  for (int axis = 0; axis < 6; ++axis)
    counts[static_cast<std::size_t>(axis)] = static_cast<std::int16_t>((7 * i + 50 * axis) % 701 - 350);
  return counts;
}

class SpaceMouseBench final : public DriverBench {
 public:
  /// Three reports a moment, 125 times a second. It feels nothing and takes no command: the wrench stays on
  /// this side, and whatever has to do with arming and pushing has no meaning for it. Nor has a wrong
  /// checksum, as HID leaves that to USB itself: what has the right number and size is believed, within full
  /// deflection. What has not is left alone, as models have reports of their own (batteries).
  Traits traits() const override {
    return {.driver = DeviceDriver::SpaceMouse,
            .rate = 375.0,
            .pushes = false,
            .opened = DeviceState::Armed,
            .whenSilent = std::nullopt,
            .whenRefusing = std::nullopt,
            .isStoppedByGarbage = false,
            .out = 0};
  }
  const std::shared_ptr<EmulatedDevice>& emulated() const override { return emulator_.device(); }
  std::unique_ptr<HapticDevice> make(const UsbDescription& seen, const SafetyLimits&) override {
    return std::make_unique<SpaceMouseDevice>(seen);
  }

  void start(HapticDevice& device) override { device.start({}); }
  void hold(int i) override {
    emulator_.withFirmware([&](SpaceMouseFirmware& firmware) {
      firmware.counts = countsAt(i);
      firmware.buttons = static_cast<std::uint16_t>(i % 4);
    });
  }
  /// A report tells of three axes, or of the buttons.
  void expectHeld(HapticDevice& device, const HandleInput& handle, int i) override {
    const SpaceMouseState& newest = static_cast<SpaceMouseDevice&>(device).newest();
    if (last_ == 2) {
      EXPECT_EQ(newest.buttons, static_cast<std::uint64_t>(i % 4));
      EXPECT_EQ(handle.buttons, newest.buttons);
      return;
    }
    const std::array<std::int16_t, 6> counts = countsAt(i);
    for (std::size_t axis = 3 * last_; axis < 3 * last_ + 3; ++axis)
      EXPECT_DOUBLE_EQ(newest.axes[axis], kSigns[axis] * counts[axis] / kFullScale);
  }
  bool round(HapticDevice& device, const Wrench& wrench, HandleInput& handle) override {
    const std::uint64_t before = device.counters().poses;
    const auto sending = emulated()->send(traits().in, nextReport());
    if (sending != EmulatedDevice::Sending::Taken && sending != EmulatedDevice::Sending::HadToWait)
      return false;
    last_ = next_;
    next_ = (next_ + 1) % 3;
    if (!promptly([&] { return device.counters().poses == before + 1; })) return false;
    if (!device.readHandle(handle)) return false;
    device.sendWrench(wrench);
    return true;
  }

  void stream() override {
    emulator_.stream([](SpaceMouseFirmware& firmware, double) { firmware.counts = {350, 0, 0, 0, 0, 0}; });
  }
  void stopStreaming() override { emulator_.stopStreaming(); }
  void powerOff() override {
    stopStreaming();
    emulator_.withFirmware([](SpaceMouseFirmware& firmware) { firmware.isLit = false; });
    next_ = 0;
  }

  std::vector<BadReport> badReports() const override {
    return {{"empty", [](Bytes& bytes) { bytes.clear(); }},
            {"nothing but its number", [](Bytes& bytes) { bytes.resize(1); }},
            {"unknown number", [](Bytes& bytes) { bytes[0] = std::byte{0x77}; }},
            {"oversized", [](Bytes& bytes) { bytes.resize(64); }, true},
            {"garbage", [](Bytes& bytes) { bytes.assign(bytes.size(), std::byte{0xa5}); }}};
  }
  void sendBad(HapticDevice&, const BadReport& bad) override {
    Bytes bytes = nextReport();
    bad.damage(bytes);
    emulated()->send(traits().in, bytes);
  }

 private:
  Bytes nextReport() {
    return emulator_.withFirmware([&](const auto& firmware) { return firmware.reports().at(next_); });
  }

  SpaceMouseEmulator emulator_;
  std::size_t next_ = 0, last_ = 0;  ///< Of a moment's reports.
};

}  // namespace

std::unique_ptr<DriverBench> spaceMouseBench() {
  return std::make_unique<SpaceMouseBench>();
}

}  // namespace nearfit::test
