#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "core/realtime/triple_buffer.h"
#include "device/device_error.h"
#include "device/passive_device.h"
#include "device/rate_control.h"
#include "device/servo/monotonic_clock.h"
#include "device/spacemouse/spacemouse_reader.h"
#include "device/usb/usb_link.h"

namespace nearfit {

/// A space mouse: pushing its cap drives the part by velocity. It feels nothing, so the wrench is for the
/// picture, and keeps the handle from wandering off while the part stands at a wall. Works as it is plugged
/// in; there is nothing to arm. While its first button is held the part stays; its second takes the handle
/// back to where the part is.
class SpaceMouseDevice final : public PassiveDevice, public RateDriven, private UsbPacketSink {
 public:
  /// True for 3Dconnexion's devices, also of the years when Logitech's name was on them.
  static bool speaks(const UsbDescription& device) noexcept;
  /// For those of them that are no space mice.
  static std::optional<DeviceRefusal> refusal(const UsbDescription& device);

  /// Opens nothing yet.
  explicit SpaceMouseDevice(UsbDescription device);
  ~SpaceMouseDevice() override;

  void setRate(const RateSettings& settings) override;

  DeviceInfo info() const override;
  DeviceState state() const noexcept override { return state_.load(std::memory_order_acquire); }
  std::string stateNote() const override;
  void start(const RigidTransform& worldFromPart, const ProgressCallback& progress = {}) override;
  void stop() noexcept override;
  /// The servo paces it: reports come every 8 or 16 ms, and none while the cap rests.
  bool waitForHandle(Nanoseconds deadline) noexcept override;
  bool readHandle(HandleInput& handle) noexcept override;
  void sendWrench(const Wrench& wrench) noexcept override { wrench_ = wrench; }

  /// Buttons that are down, and deflections, as of the last report. Controlling thread.
  const SpaceMouseState& newest() noexcept;
  ReportCounters counters() const noexcept override;

 private:
  struct Sample {
    SpaceMouseState state;
    Nanoseconds arrived = 0;
  };

  void onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept override;
  void onLost(UsbLoss loss) noexcept override;
  /// Opens the interface that has the six axes: link, reader, interface. @return Its endpoint's address.
  std::uint8_t openAxes();
  void open(const UsbInterface& face);
  /// Empty when the device does not give it.
  std::vector<std::byte> readDescriptor();
  void light(bool isOn) noexcept;
  std::string name() const;

  const UsbDescription device_;
  std::uint8_t interfaceNumber_ = 0;
  std::optional<UsbLink> link_;
  std::optional<SpaceMouseReader> reader_;
  std::string product_;
  std::atomic<DeviceState> state_{DeviceState::Present};
  std::atomic<UsbLoss> loss_{UsbLoss::None};
  std::atomic<std::uint64_t> reports_{0}, rejected_{0};

  TripleBuffer<RateSettings> settings_;
  // From the link's thread: for the servo, and for whoever shows buttons.
  TripleBuffer<Sample> samples_;
  TripleBuffer<SpaceMouseState> shown_;

  // The link thread's own: reports tell of a part of the axes each.
  SpaceMouseState newest_;

  // The servo thread's own.
  RateControl control_;
  Wrench wrench_;
  Nanoseconds lastRead_ = 0;
  bool wasLettingGo_ = false;
};

}  // namespace nearfit
