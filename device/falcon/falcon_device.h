#pragma once

#include <array>
#include <filesystem>

#include "device/falcon/falcon_protocol.h"
#include "device/force_arm_device.h"
#include "device/velocity_filter.h"

namespace nearfit {

/// A Novint Falcon over USB: three axes sensed and driven; its grip does not turn. It forgets its firmware
/// when it is switched off: that is loaded from a file of the user's. Uncalibrated until its handle has been
/// moved out and in, past the encoders' indexes, while the servo runs.
class FalconDevice final : public ForceArmDevice {
 public:
  static bool speaks(const UsbDescription& device) noexcept;

  /// Opens nothing yet.
  /// @param firmware  May be empty as long as the device has its firmware.
  FalconDevice(UsbDescription device, std::filesystem::path firmware, const SafetyLimits& safety = {});
  ~FalconDevice() override { stop(); }

  std::string stateNote() const override;
  /// It looks for its indexes by itself as long as it is uncalibrated.
  void calibrate() override {}

 private:
  Opened open(std::optional<UsbLink>& link, const ProgressCallback& progress) override;
  void take(std::span<const std::byte> packet, Nanoseconds arrived) noexcept override;
  std::span<const std::byte> command(const glm::dvec3& force, const ArmSample& at) noexcept override;
  void take(const falcon::Report& report, Nanoseconds arrived) noexcept;

  const std::filesystem::path firmware_;

  // The link thread's.
  falcon::FrameReader reader_;
  glm::dvec3 last_{0.0};  ///< Where the grip was.
  bool isHomed_ = false;
  VelocityFilter velocity_;

  std::array<std::byte, falcon::kFrameSize> command_{};  ///< The servo thread's.
};

}  // namespace nearfit
