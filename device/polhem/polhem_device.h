#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "device/common/force_arm_device.h"
#include "device/common/velocity_filter.h"
#include "device/polhem/polhem_kinematics.h"
#include "device/polhem/polhem_protocol.h"

namespace nearfit {

/// A WoodenHaptics or Polhem over USB: senses six joints with a gimbal, three without; drives three.
/// It counts from wherever it was switched on, so it is uncalibrated until told that the hand holds
/// it in its rest pose.
class PolhemDevice final : public ForceArmDevice {
 public:
  /// True if it has the IDs of these devices, or of a Teensy that speaks raw HID, and the endpoints.
  static bool speaks(const UsbDescription& device) noexcept;

  /// Opens nothing yet.
  PolhemDevice(UsbDescription device, const polhem::Calibration& calibration,
               const SafetyLimits& safety = {});
  ~PolhemDevice() override { stop(); }

  std::string stateNote() const override;
  /// Takes the pose at the next report as the rest pose of the calibration; the device's own button does the
  /// same. Holds until the device is unplugged or proves wrong.
  void calibrate() override;

 private:
  Opened open(std::optional<UsbLink>& link, const ProgressCallback& progress) override;
  void take(std::span<const std::byte> packet, Nanoseconds arrived) noexcept override;
  std::span<const std::byte> command(const glm::dvec3& force, const ArmSample& at) noexcept override;
  ArmSample restSample() const noexcept;
  bool isRestShown(const polhem::Report& report) noexcept;

  const polhem::Calibration calibration_;
  const polhem::Kinematics kinematics_;
  std::size_t packetSize_ = polhem::kPacketSize;
  std::atomic<bool> isCalibrationDue_{false};

  // Link's thread; the controlling thread while nothing streams.
  bool isCalibrated_ = false;
  std::array<std::int16_t, 6> rest_{};
  VelocityFilter velocity_;
  bool hasReport_ = false, wasButtonPressed_ = false;

  std::array<std::byte, polhem::kRawHidSize> command_{};  ///< Servo thread only.
};

}  // namespace nearfit
