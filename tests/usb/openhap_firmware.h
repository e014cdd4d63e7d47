#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/openhap/openhap_protocol.h"

namespace nearfit::test {

/// The device's side of OpenHap, as resources/docs/openhap.md asks for it: what firmware has to do, without
/// hardware. No thread and no clock: time comes in.
class OpenHapFirmware {
 public:
  explicit OpenHapFirmware(const openhap::Capabilities& capabilities);

  /// A vendor request to the interface. Nothing: stall.
  std::optional<std::vector<std::byte>> onRequest(std::uint8_t requestType, std::uint8_t request);
  /// A packet on the OUT endpoint.
  void onPacket(std::span<const std::byte> packet, double time);
  /// As time passes; often enough for the watchdog and for forces that fade.
  void onTime(double time);
  void onDisconnected() { disarm(); }

  /// The next pose report, with the handle as it is held.
  std::array<std::byte, openhap::kPoseSize> poseReport(double time);

  struct Rendered {
    std::array<float, 3> force{}, torque{};
  };
  /// What its motors do, as of the last onTime().
  Rendered rendered() const;

  /// Forces begin and end within this, so that neither is a knock [s].
  static constexpr double kRampTime = 2e-3;

  bool isArmed() const { return isArmed_; }
  bool isWatchdogTripped() const { return isWatchdogTripped_; }
  std::uint64_t accepted() const { return accepted_; }
  std::uint64_t ignored() const { return ignored_; }
  const openhap::WrenchReport& lastWrench() const { return wrench_; }

  // What the hand and the mechanics do.
  openhap::PoseReport handle;
  bool isDeadManHeld = false, isHomed = true;
  std::string fault;

 private:
  void disarm();
  bool mayPush() const;
  void fade(double passed);

  openhap::Capabilities capabilities_;
  bool isArmed_ = false, isWatchdogTripped_ = false;
  openhap::WrenchReport wrench_;
  Rendered asked_;           ///< By the last wrench with forces on; what fades when they are to end.
  double share_ = 0.0;       ///< Of that, that its motors are given.
  double wrenchTime_ = 0.0;  ///< When the last valid one came; while armed, at the earliest when it was.
  double now_ = 0.0;
  std::uint16_t sequence_ = 0;
  std::uint64_t accepted_ = 0, ignored_ = 0;
};

}  // namespace nearfit::test
