#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "device/haptic_device.h"
#include "device/streamed_handle.h"
#include "device/usb/usb_link.h"

namespace nearfit {

/// What a driver makes of an arm's report.
struct ArmSample {
  RigidTransform pose;
  glm::dvec3 joints{0.0};    ///< Angles of the three driven joints [rad].
  glm::dvec3 velocity{0.0};  ///< [m/s]
  std::uint8_t buttons = 0;
};

/// A device of three motors that answers each command with a report of where its joints are, and does not
/// know where they are until it is calibrated. Drivers of such devices say how it is opened, what its reports
/// mean and what its motors are told; their destructors call stop().
class ForceArmDevice : public HapticDevice, private UsbPacketSink {
 public:
  DeviceInfo info() const override;
  DeviceState state() const noexcept override { return handle_.state(); }
  void start(const RigidTransform& worldFromPart, const ProgressCallback& progress = {}) override;
  void stop() noexcept override;
  void arm() override { handle_.supervisor().arm(name()); }
  void disarm() noexcept override { handle_.supervisor().disarm(); }
  void reset() override { handle_.supervisor().reset(); }
  bool waitForHandle(Nanoseconds deadline) noexcept override { return handle_.wait(deadline); }
  bool readHandle(HandleInput& handle) noexcept override;
  void sendWrench(const Wrench& wrench) noexcept override;

  ReportCounters counters() const noexcept override { return handle_.counters(); }
  UsbCounters linkCounters() const noexcept { return link_ ? link_->counters() : UsbCounters{}; }

 protected:
  ForceArmDevice(UsbDescription device, std::string kind, const DeviceLimits& limits,
                 const SafetyLimits& safety);

  struct Opened {
    UsbLink::Streams streams;
    bool isCalibrated = false;
    ArmSample rest;  ///< Where the handle is said to be until it is known.
    double reportPeriod = 1e-3;
  };
  /// Controlling thread: makes the device ready to stream. Throws DeviceError, Cancelled.
  virtual Opened open(std::optional<UsbLink>& link, const ProgressCallback& progress) = 0;
  /// The link's thread: calls publish() or reject() of handle(), if anything.
  virtual void take(std::span<const std::byte> packet, Nanoseconds arrived) noexcept = 0;
  /// Servo thread: the packet that makes the motors push with `force` [N]; of none, the motors rest. It stays
  /// until the next call.
  virtual std::span<const std::byte> command(const glm::dvec3& force, const ArmSample& at) noexcept = 0;

  StreamedHandle<ArmSample>& handle() noexcept { return handle_; }
  const StreamedHandle<ArmSample>& handle() const noexcept { return handle_; }
  const UsbDescription& description() const noexcept { return device_; }
  std::string name() const;

 private:
  void onPacket(std::span<const std::byte> packet, std::int64_t arrived) noexcept final {
    take(packet, arrived);
  }
  void onLost(UsbLoss loss) noexcept final { handle_.lose(loss); }
  void restMotors() noexcept;

  const UsbDescription device_;
  const std::string kind_;
  const DeviceLimits limits_;
  const SafetyLimits safety_;
  std::optional<UsbLink> link_;
  Opened opened_;
  std::string product_;
  StreamedHandle<ArmSample> handle_;
};

}  // namespace nearfit
