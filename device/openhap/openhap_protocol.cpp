#include "device/openhap/openhap_protocol.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace nearfit::openhap {
namespace {

enum ReportKind : std::uint8_t { kPoseKind = 1, kWrenchKind = 2, kCapabilitiesKind = 3 };
constexpr std::size_t kChecksumSize = 2;

/// Larger numbers are absurd for a device held by a hand: [N], [m], [rad/s] and the like.
constexpr float kMaxOfAnything = 1e6F;

class Writer {
 public:
  explicit Writer(std::span<std::byte> bytes) noexcept : bytes_(bytes) {}

  void u8(std::uint8_t value) noexcept { bytes_[at_++] = std::byte{value}; }
  void u16(std::uint16_t value) noexcept {
    u8(static_cast<std::uint8_t>(value & 0xffU));
    u8(static_cast<std::uint8_t>(value >> 8U));
  }
  void u32(std::uint32_t value) noexcept {
    u16(static_cast<std::uint16_t>(value & 0xffffU));
    u16(static_cast<std::uint16_t>(value >> 16U));
  }
  void f32(float value) noexcept { u32(std::bit_cast<std::uint32_t>(value)); }
  template <std::size_t n>
  void f32(const std::array<float, n>& values) noexcept {
    for (const float value : values)
      f32(value);
  }
  /// Pads with zeros and appends the checksum.
  void close() noexcept {
    while (at_ < bytes_.size() - kChecksumSize)
      u8(0);
    u16(crc16(bytes_.first(at_)));
  }

 private:
  std::span<std::byte> bytes_;
  std::size_t at_ = 0;
};

class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

  std::uint8_t u8() noexcept { return std::to_integer<std::uint8_t>(bytes_[at_++]); }
  std::uint16_t u16() noexcept {
    const std::uint16_t low = u8();
    return static_cast<std::uint16_t>(low | u8() << 8U);
  }
  std::uint32_t u32() noexcept {
    const std::uint32_t low = u16();
    return low | std::uint32_t{u16()} << 16U;
  }
  /// Reads a float; remembers if it is not finite or absurd.
  float f32() noexcept {
    const float value = std::bit_cast<float>(u32());
    if (!std::isfinite(value))
      areFinite_ = false;
    else if (std::abs(value) > kMaxOfAnything)
      areInRange_ = false;
    return value;
  }
  template <std::size_t n>
  void f32(std::array<float, n>& values) noexcept {
    for (float& value : values)
      value = f32();
  }
  Reject verdict() const noexcept {
    if (!areFinite_) return Reject::NotFinite;
    return areInRange_ ? Reject::None : Reject::OutOfRange;
  }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  bool areFinite_ = true, areInRange_ = true;
};

Reject checkEnvelope(std::span<const std::byte> bytes, std::size_t size, ReportKind kind) noexcept {
  if (bytes.size() != size) return Reject::Size;
  if (std::to_integer<std::uint8_t>(bytes[0]) != kind) return Reject::Kind;
  const std::size_t end = size - kChecksumSize;
  const std::uint16_t said = Reader(bytes.subspan(end)).u16();
  return said == crc16(bytes.first(end)) ? Reject::None : Reject::Checksum;
}

enum CapabilityFlags : std::uint8_t { kOrientation = 1, kTorque = 2, kDeadMan = 4, kHoming = 8 };

bool areUsable(const Capabilities& is) noexcept {
  const std::array<float, 9> amounts = {is.maxForce,          is.maxTorque,    is.damping,
                                        is.rotationalDamping, is.mass,         is.inertia,
                                        is.workspace[0],      is.workspace[1], is.workspace[2]};
  for (const float amount : amounts) {
    if (amount < 0.0F) return false;
  }
  return is.rate > 0 && is.watchdogMs > 0 && is.maxSpeed >= 0.0F;
}

}  // namespace

std::uint16_t crc16(std::span<const std::byte> bytes) noexcept {
  std::uint32_t crc = 0xffff;
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<std::uint32_t>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit)
      crc = ((crc & 0x8000U) != 0 ? (crc << 1U) ^ 0x1021U : crc << 1U) & 0xffffU;
  }
  return static_cast<std::uint16_t>(crc);
}

std::array<std::byte, kCapabilitiesSize> encode(const Capabilities& is) noexcept {
  std::array<std::byte, kCapabilitiesSize> bytes{};
  Writer to(bytes);
  to.u8(kCapabilitiesKind);
  to.u8(is.major);
  to.u8(is.minor);
  to.u8(static_cast<std::uint8_t>((is.sensesOrientation ? kOrientation : 0) |
                                  (is.rendersTorque ? kTorque : 0) | (is.hasDeadMan ? kDeadMan : 0) |
                                  (is.needsHoming ? kHoming : 0)));
  to.u8(is.buttonCount);
  to.u8(0);
  to.u16(is.rate);
  to.u16(is.watchdogMs);
  to.u16(0);
  for (const float value : {is.maxForce, is.maxTorque, is.damping, is.rotationalDamping, is.mass, is.inertia})
    to.f32(value);
  to.f32(is.workspace);
  to.f32(is.maxSpeed);
  to.close();
  return bytes;
}

std::array<std::byte, kPoseSize> encode(const PoseReport& report) noexcept {
  std::array<std::byte, kPoseSize> bytes{};
  Writer to(bytes);
  to.u8(kPoseKind);
  to.u8(report.status);
  to.u16(report.sequence);
  to.u32(report.microseconds);
  to.f32(report.position);
  to.f32(report.rotation);
  to.f32(report.velocity);
  to.f32(report.angularVelocity);
  to.u16(report.buttons);
  to.close();
  return bytes;
}

std::array<std::byte, kWrenchSize> encode(const WrenchReport& report) noexcept {
  std::array<std::byte, kWrenchSize> bytes{};
  Writer to(bytes);
  to.u8(kWrenchKind);
  to.u8(report.flags);
  to.u16(report.sequence);
  to.f32(report.force);
  to.f32(report.torque);
  to.u16(report.timeToLiveMs);
  to.close();
  return bytes;
}

Reject decode(std::span<const std::byte> bytes, Capabilities& capabilities) noexcept {
  if (const Reject reject = checkEnvelope(bytes, kCapabilitiesSize, kCapabilitiesKind);
      reject != Reject::None)
    return reject;
  Reader from(bytes.subspan(1));
  Capabilities is;
  is.major = from.u8();
  is.minor = from.u8();
  if (is.major != kMajorVersion) return Reject::Version;
  const std::uint8_t flags = from.u8();
  is.sensesOrientation = (flags & kOrientation) != 0;
  is.rendersTorque = (flags & kTorque) != 0;
  is.hasDeadMan = (flags & kDeadMan) != 0;
  is.needsHoming = (flags & kHoming) != 0;
  is.buttonCount = from.u8();
  from.u8();
  is.rate = from.u16();
  is.watchdogMs = from.u16();
  from.u16();
  for (float* value :
       {&is.maxForce, &is.maxTorque, &is.damping, &is.rotationalDamping, &is.mass, &is.inertia})
    *value = from.f32();
  from.f32(is.workspace);
  is.maxSpeed = from.f32();
  if (from.verdict() != Reject::None) return from.verdict();
  if (!areUsable(is)) return Reject::OutOfRange;
  capabilities = is;
  return Reject::None;
}

Reject decode(std::span<const std::byte> bytes, PoseReport& report) noexcept {
  if (const Reject reject = checkEnvelope(bytes, kPoseSize, kPoseKind); reject != Reject::None) return reject;
  Reader from(bytes.subspan(1));
  PoseReport is;
  is.status = from.u8();
  is.sequence = from.u16();
  is.microseconds = from.u32();
  from.f32(is.position);
  from.f32(is.rotation);
  from.f32(is.velocity);
  from.f32(is.angularVelocity);
  is.buttons = from.u16();
  if (from.verdict() != Reject::None) return from.verdict();
  float lengthSquared = 0.0F;
  for (const float part : is.rotation)
    lengthSquared += part * part;
  if (!(std::abs(std::sqrt(lengthSquared) - 1.0F) <= kQuaternionSlack)) return Reject::NotUnit;
  report = is;
  return Reject::None;
}

Reject decode(std::span<const std::byte> bytes, WrenchReport& report) noexcept {
  if (const Reject reject = checkEnvelope(bytes, kWrenchSize, kWrenchKind); reject != Reject::None)
    return reject;
  Reader from(bytes.subspan(1));
  WrenchReport is;
  is.flags = from.u8();
  is.sequence = from.u16();
  from.f32(is.force);
  from.f32(is.torque);
  is.timeToLiveMs = from.u16();
  if (from.verdict() != Reject::None) return from.verdict();
  report = is;
  return Reject::None;
}

std::string textOf(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte each : bytes.first(std::min(bytes.size(), kFaultTextSize))) {
    const char c = static_cast<char>(each);
    if (c == '\0') break;
    text += c < 0x20 || c > 0x7e ? '?' : c;
  }
  return text;
}

}  // namespace nearfit::openhap
