#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "device/common/report_stream.h"
#include "device/interface/haptic_device.h"
#include "device/usb/usb_link.h"

namespace nearfit {

/// One decoded report of an arm.
struct ArmSample {
  RigidTransform pose;       ///< Pose of the handle in the device's frame.
  glm::dvec3 joints{0.0};    ///< Angles of the three driven joints [rad].
  glm::dvec3 velocity{0.0};  ///< Velocity of the handle [m/s].
  std::uint8_t buttons = 0;  ///< Bit 0 is the clutch.
};

/// Base of devices with three motors that answer each command with a report of their joints, and that do not
/// know where their joints are until calibrated. A driver says how to open the device, decode its reports and
/// encode commands; its destructor must call stop().
class ForceArmDevice : public HapticDevice, private UsbPacketSink {
 public:
  DeviceInfo info() const override;
  DeviceState state() const noexcept override { return stream_.state(); }
  void start(const RigidTransform& worldFromPart, const ProgressCallback& progress = {}) override;
  void stop() noexcept override;
  void arm() override { stream_.supervisor().arm(name()); }
  void disarm() noexcept override { stream_.supervisor().disarm(); }
  void reset() override { stream_.supervisor().reset(); }
  bool waitForHandle(Nanoseconds deadline) noexcept override { return stream_.wait(deadline); }
  bool readHandle(HandleInput& handle) noexcept override;
  void sendWrench(const Wrench& wrench) noexcept override;

  ReportCounters counters() const noexcept override { return stream_.counters(); }
  /// USB counters of the open link; zeros while closed.
  UsbCounters linkCounters() const noexcept { return link_ ? link_->counters() : UsbCounters{}; }

 protected:
  /// @param sensedAxes  6 if its handle turns and that is sensed, else 3.
  ForceArmDevice(UsbDescription device, std::string kind, const DeviceLimits& limits,
                 const SafetyLimits& safety, int sensedAxes);

  /// Result of open().
  struct Opened {
    UsbLink::Streams streams;
    bool isCalibrated = false;
    ArmSample rest;              ///< Assumed until the handle's pose is known.
    double reportPeriod = 1e-3;  ///< [s]
  };
  /// Controlling thread: emplaces `link` and prepares the device for streaming.
  /// Throws DeviceError, Cancelled.
  virtual Opened open(std::optional<UsbLink>& link, const ProgressCallback& progress) = 0;
  /// Link's thread: decodes a packet; calls publish() or reject() of stream() if it holds a
  /// report. Real-time safe.
  /// @param arrived  Arrival on CLOCK_MONOTONIC [ns].
  virtual void take(std::span<const std::byte> packet, Nanoseconds arrived) noexcept = 0;
  /// Servo thread: returns the packet that makes the motors push with `force` [N], in the device's frame, at
  /// the pose `at`; zero rests the motors. Valid until the next call. Real-time safe.
  virtual std::span<const std::byte> command(const glm::dvec3& force, const ArmSample& at) noexcept = 0;

  ReportStream<ArmSample>& stream() noexcept { return stream_; }
  const ReportStream<ArmSample>& stream() const noexcept { return stream_; }
  const UsbDescription& description() const noexcept { return device_; }
  /// Returns the device's name with its USB ID and node, for messages.
  std::string name() const;

 private:
  void onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept final {
    take(packet, arrived);
  }
  void onLost(UsbLoss loss) noexcept final { stream_.lose(loss); }
  void restMotors() noexcept;

  const UsbDescription device_;
  const std::string kind_;
  const DeviceLimits limits_;
  const SafetyLimits safety_;
  const int sensedAxes_;
  std::optional<UsbLink> link_;
  Opened opened_;
  std::string product_;
  ReportStream<ArmSample> stream_;
};

}  // namespace nearfit
