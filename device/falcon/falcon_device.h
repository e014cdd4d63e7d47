#pragma once

#include <array>
#include <filesystem>

#include "device/common/force_arm_device.h"
#include "device/common/velocity_filter.h"
#include "device/falcon/falcon_protocol.h"

namespace nearfit {

/// A Novint Falcon over USB: senses and drives three axes; its grip does not turn. It forgets its firmware
/// when switched off, so start() loads it from a file of the user's. Uncalibrated until the handle has been
/// moved out and in, past the encoders' indexes, while the servo runs.
class FalconDevice final : public ForceArmDevice {
 public:
  /// True if it is a Falcon and has the endpoints that this driver needs.
  static bool speaks(const UsbDescription& device) noexcept;

  /// Opens nothing yet.
  /// @param firmware  File; may be empty while the device has its firmware.
  FalconDevice(UsbDescription device, std::filesystem::path firmware, const SafetyLimits& safety = {});
  ~FalconDevice() override { stop(); }

  std::string stateNote() const override;
  /// No-op: while uncalibrated, the device searches for its indexes by itself.
  void calibrate() override {}

 private:
  Opened open(std::optional<UsbLink>& link, const ProgressCallback& progress) override;
  void take(std::span<const std::byte> packet, Nanoseconds arrived) noexcept override;
  std::span<const std::byte> command(const glm::dvec3& force, const ArmSample& at) noexcept override;
  void take(const falcon::Report& report, Nanoseconds arrived) noexcept;

  const std::filesystem::path firmware_;

  // Link's thread only.
  falcon::FrameReader reader_;
  glm::dvec3 last_{0.0};  ///< Last position of the grip [m].
  bool isHomed_ = false;
  VelocityFilter velocity_;

  std::array<std::byte, falcon::kFrameSize> command_{};  ///< Servo thread only.
};

}  // namespace nearfit
