#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "core/realtime/triple_buffer.h"
#include "device/common/passive_device.h"
#include "device/common/rate_control.h"
#include "device/interface/device_error.h"
#include "device/spacemouse/spacemouse_reader.h"
#include "device/thread/monotonic_clock.h"
#include "device/usb/usb_link.h"

namespace nearfit {

/// A space mouse: pushing its cap drives the handle by velocity. It renders no force; the wrench is shown,
/// and keeps the handle from running on while the part stands at a wall. Needs no arming. The first button
/// holds the part while pressed; the second takes the handle back to the part.
class SpaceMouseDevice final : public PassiveDevice, public RateDriven, private UsbPacketSink {
 public:
  /// True if 3Dconnexion made it, under its own or Logitech's name, and it sends reports. Not all of these are
  /// space mice: see refusal().
  static bool speaks(const UsbDescription& device) noexcept;
  /// Returns why it is not a space mouse, as far as that shows without opening it;
  /// std::nullopt if it may be one.
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
  /// Sleeps until the deadline: reports come every 8 or 16 ms, and none while the cap rests, so the
  /// servo sets the pace.
  bool waitForHandle(Nanoseconds deadline) noexcept override;
  bool readHandle(HandleInput& handle) noexcept override;
  void sendWrench(const Wrench& wrench) noexcept override { wrench_ = wrench; }

  /// Controlling thread: returns buttons and deflections of the last report; valid until the next call.
  const SpaceMouseState& newest() noexcept;
  ReportCounters counters() const noexcept override;

 private:
  struct Sample {
    SpaceMouseState state;
    Nanoseconds arrived = 0;
  };

  void onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept override;
  void onLost(UsbLoss loss) noexcept override;
  /// Opens the interface that has the six axes: sets link, reader and interface number. Returns
  /// its endpoint address.
  std::uint8_t openAxes();
  void open(const UsbInterface& face);
  /// Returns an empty descriptor if the device gives none.
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
  // From the link's thread: one for the servo, one for display.
  TripleBuffer<Sample> samples_;
  TripleBuffer<SpaceMouseState> shown_;

  // Link's thread only; kept because a report may carry only some of the axes.
  SpaceMouseState newest_;

  // Servo thread only.
  RateControl control_;
  Wrench wrench_;
  Nanoseconds lastRead_ = 0;
  bool wasLettingGo_ = false;
};

}  // namespace nearfit
