#include "tests/usb/openhap_firmware.h"

#include <algorithm>
#include <cmath>

namespace nearfit::test {
namespace {

using openhap::Request;

std::array<float, 3> clamped(const std::array<float, 3>& v, float most) {
  const float length = std::hypot(v[0], v[1], v[2]);
  if (!(length > most)) return v;
  return {v[0] * most / length, v[1] * most / length, v[2] * most / length};
}

}  // namespace

OpenHapFirmware::OpenHapFirmware(const openhap::Capabilities& capabilities)
    : isHomed(!capabilities.needsHoming), capabilities_(capabilities) {}

std::optional<std::vector<std::byte>> OpenHapFirmware::onRequest(std::uint8_t requestType,
                                                                 std::uint8_t request) {
  const std::vector<std::byte> nothing;
  if (requestType == openhap::kRequestIn && request == static_cast<std::uint8_t>(Request::Capabilities)) {
    const auto bytes = encode(capabilities_);
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  }
  if (requestType == openhap::kRequestIn && request == static_cast<std::uint8_t>(Request::FaultText)) {
    const std::span<const std::byte> text = std::as_bytes(std::span(fault));
    const std::size_t size = std::min(text.size(), openhap::kFaultTextSize);
    return std::vector<std::byte>(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size));
  }
  if (requestType != openhap::kRequestOut) return std::nullopt;
  switch (static_cast<Request>(request)) {
    case Request::Arm:
      if (!isHomed || !fault.empty() || isWatchdogTripped_) return std::nullopt;
      isArmed_ = true;
      wrenchTime_ = now_;
      return nothing;
    case Request::Disarm:
      disarm();
      isWatchdogTripped_ = false;
      return nothing;
    case Request::Home:
      isHomed = true;
      return nothing;
    default:
      return std::nullopt;
  }
}

void OpenHapFirmware::onPacket(std::span<const std::byte> packet, double time) {
  onTime(time);
  openhap::WrenchReport report;
  if (decode(packet, report) != openhap::Reject::None) {
    ++ignored_;
    return;
  }
  ++accepted_;
  wrench_ = report;
  wrenchTime_ = time;
  if (!mayPush()) return;
  asked_.force = clamped(report.force, capabilities_.maxForce);
  if (capabilities_.rendersTorque) asked_.torque = clamped(report.torque, capabilities_.maxTorque);
}

void OpenHapFirmware::onTime(double time) {
  if (!fault.empty()) disarm();
  const double passed = time - now_;
  now_ = time;
  if (isArmed_ && time - wrenchTime_ > 1e-3 * capabilities_.watchdogMs) {
    disarm();
    isWatchdogTripped_ = true;
  }
  fade(passed);
}

void OpenHapFirmware::disarm() {
  isArmed_ = false;
  wrench_ = {};
}

bool OpenHapFirmware::mayPush() const {
  const bool isExpired = now_ - wrenchTime_ > 1e-3 * wrench_.timeToLiveMs;
  return isArmed_ && (wrench_.flags & openhap::kForcesOn) != 0 && !isExpired &&
         (isDeadManHeld || !capabilities_.hasDeadMan);
}

void OpenHapFirmware::fade(double passed) {
  const double most = std::max(passed, 0.0) / kRampTime;
  share_ = std::clamp(mayPush() ? share_ + most : share_ - most, 0.0, 1.0);
}

std::array<std::byte, openhap::kPoseSize> OpenHapFirmware::poseReport(double time) {
  onTime(time);
  openhap::PoseReport report = handle;
  report.status = static_cast<std::uint8_t>(
      (isHomed ? openhap::kHomed : 0) | (isDeadManHeld ? openhap::kDeadManHeld : 0) |
      (fault.empty() ? 0 : openhap::kFaulted) | (isWatchdogTripped_ ? openhap::kWatchdogTripped : 0) |
      (isArmed_ ? openhap::kArmed : 0));
  report.sequence = sequence_++;
  // The clock wraps after 71 minutes.
  report.microseconds = static_cast<std::uint32_t>(static_cast<std::uint64_t>(time * 1e6));
  return encode(report);
}

OpenHapFirmware::Rendered OpenHapFirmware::rendered() const {
  const auto shareOf = [this](std::array<float, 3> v) {
    for (float& each : v)
      each *= static_cast<float>(share_);
    return v;
  };
  return {shareOf(asked_.force), shareOf(asked_.torque)};
}

}  // namespace nearfit::test
