#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace nearfit::openhap {

/// The protocol as resources/docs/openhap.md has it: bytes to values and back. Pure; real-time safe. Numbers
/// are little-endian, floats IEEE 754 of 32 bits; CRC-16/CCITT-FALSE over all bytes before it.

constexpr std::uint8_t kInterfaceClass = 0xff, kInterfaceSubclass = 0x48;  ///< 'H'
constexpr std::uint8_t kMajorVersion = 1;                                  ///< The interface's protocol.

/// Vendor requests to the interface.
enum class Request : std::uint8_t { Capabilities = 1, Arm = 2, Disarm = 3, Home = 4, FaultText = 5 };
constexpr std::uint8_t kRequestIn = 0xc1, kRequestOut = 0x41;

constexpr std::size_t kCapabilitiesSize = 64, kPoseSize = 64, kWrenchSize = 32, kFaultTextSize = 64;

struct Capabilities {
  std::uint8_t major = kMajorVersion, minor = 0;
  bool sensesOrientation = true, rendersTorque = true, hasDeadMan = false, needsHoming = false;
  std::uint8_t buttonCount = 0;
  std::uint16_t rate = 1000;         ///< Pose reports a second [Hz].
  std::uint16_t watchdogMs = 20;     ///< Without a wrench for so long, its forces go to zero and it disarms.
  float maxForce = 0.0F;             ///< [N]
  float maxTorque = 0.0F;            ///< [N m]
  float damping = 0.0F;              ///< Physical, [N s/m].
  float rotationalDamping = 0.0F;    ///< [N m s/rad]
  float mass = 0.0F;                 ///< Of the moved parts as felt at the handle [kg].
  float inertia = 0.0F;              ///< [kg m^2]
  std::array<float, 3> workspace{};  ///< Half the extents about the origin [m].
  float maxSpeed = 0.0F;             ///< Beyond this it brakes and faults by itself [m/s]; 0: never.
  bool operator==(const Capabilities&) const = default;
};

enum PoseStatus : std::uint8_t {
  kHomed = 1,
  kDeadManHeld = 2,
  kFaulted = 4,
  kWatchdogTripped = 8,
  kArmed = 16,
};

struct PoseReport {
  std::uint8_t status = 0;          ///< PoseStatus.
  std::uint16_t sequence = 0;       ///< One more each report; wraps.
  std::uint32_t microseconds = 0;   ///< The device's clock when the pose was measured; wraps.
  std::array<float, 3> position{};  ///< [m]
  std::array<float, 4> rotation{1.0F, 0.0F, 0.0F, 0.0F};  ///< w x y z.
  std::array<float, 3> velocity{};                        ///< [m/s]
  std::array<float, 3> angularVelocity{};                 ///< [rad/s]
  std::uint16_t buttons = 0;
  bool operator==(const PoseReport&) const = default;
};

enum WrenchFlags : std::uint8_t { kForcesOn = 1 };

struct WrenchReport {
  std::uint8_t flags = 0;         ///< WrenchFlags.
  std::uint16_t sequence = 0;     ///< Of the pose that it answers.
  std::array<float, 3> force{};   ///< On the handle, in the device's frame [N].
  std::array<float, 3> torque{};  ///< About the handle's origin [N m].
  std::uint16_t timeToLiveMs = 0;
  bool operator==(const WrenchReport&) const = default;
};

std::uint16_t crc16(std::span<const std::byte> bytes) noexcept;

std::array<std::byte, kCapabilitiesSize> encode(const Capabilities& capabilities) noexcept;
std::array<std::byte, kPoseSize> encode(const PoseReport& report) noexcept;
std::array<std::byte, kWrenchSize> encode(const WrenchReport& report) noexcept;

/// Why bytes were not taken.
enum class Reject : std::uint8_t { None, Size, Kind, Checksum, Version, NotFinite, NotUnit, OutOfRange };

/// Nothing that a device says is trusted: sizes, checksum, every number finite and in range, the quaternion
/// unit to kQuaternionSlack. On anything but None the output is left as it was.
Reject decode(std::span<const std::byte> bytes, Capabilities& capabilities) noexcept;
Reject decode(std::span<const std::byte> bytes, PoseReport& report) noexcept;
Reject decode(std::span<const std::byte> bytes, WrenchReport& report) noexcept;

/// What is printable of a fault text, up to its first zero byte: it ends up in a terminal and in a window.
std::string textOf(std::span<const std::byte> bytes);

/// Rounding of four floats, and a maker's rounder arithmetic.
constexpr float kQuaternionSlack = 1e-2F;

}  // namespace nearfit::openhap
