#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "device/common/report_stream.h"
#include "device/interface/device_error.h"
#include "device/interface/haptic_device.h"
#include "device/openhap/openhap_protocol.h"
#include "device/usb/usb_link.h"

namespace nearfit {

/// A device that speaks OpenHap (resources/docs/openhap.md) over USB.
class OpenHapDevice final : public HapticDevice, private UsbPacketSink {
 public:
  /// True if the device has an OpenHap interface, of any version.
  static bool speaks(const UsbDescription& device) noexcept;
  /// Returns a reason if the device speaks another version; else std::nullopt.
  static std::optional<DeviceRefusal> refusal(const UsbDescription& device);

  /// Opens nothing yet.
  /// @param limits  The device may lower their speeds only. It says itself whether it has a dead-man switch.
  explicit OpenHapDevice(UsbDescription device, const SafetyLimits& limits = {});
  ~OpenHapDevice() override;

  DeviceInfo info() const override;
  DeviceState state() const noexcept override { return stream_.state(); }
  std::string stateNote() const override;
  void start(const RigidTransform& worldFromPart, const ProgressCallback& progress = {}) override;
  void stop() noexcept override;
  void arm() override;
  void disarm() noexcept override;
  void calibrate() override;
  void reset() override;
  bool waitForHandle(Nanoseconds deadline) noexcept override { return stream_.wait(deadline); }
  bool readHandle(HandleInput& handle) noexcept override;
  void sendWrench(const Wrench& wrench) noexcept override;

  ReportCounters counters() const noexcept override { return stream_.counters(); }
  /// USB counters of the open link; zeros while closed.
  UsbCounters linkCounters() const noexcept { return link_ ? link_->counters() : UsbCounters{}; }

 private:
  void onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept override;
  void onLost(UsbLoss loss) noexcept override;
  openhap::Capabilities readCapabilities();
  void request(openhap::Request request);
  void askForFaultText() noexcept;
  void setFaultText(std::string text);
  std::string name() const;

  const UsbDescription device_;
  const SafetyLimits safety_;
  std::uint8_t interfaceNumber_ = 0;
  std::optional<UsbLink> link_;
  openhap::Capabilities capabilities_;
  std::string product_;
  ReportStream<openhap::PoseReport> stream_;

  mutable std::mutex faultMutex_;
  std::string faultText_;  ///< The device's own text on the fault that it reports.

  // Link's thread only.
  bool hasSequence_ = false, wasFaulted_ = false;
  std::uint16_t lastSequence_ = 0;

  // Servo thread only.
  bool hasPose_ = false;  ///< An earlier reading had a report.
  glm::dvec3 velocity_{0.0};
};

}  // namespace nearfit
