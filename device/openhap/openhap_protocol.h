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

/// Bytes to values and back, as specified in resources/docs/openhap.md. Pure; real-time safe except
/// textOf(). Numbers are little-endian, floats 32-bit IEEE 754. A CRC-16/CCITT-FALSE over all bytes before
/// it ends each message.

constexpr std::uint8_t kInterfaceClass = 0xff, kInterfaceSubclass = 0x48;  ///< 'H'
constexpr std::uint8_t kMajorVersion = 1;  ///< The interface's protocol number.

/// Vendor requests to the interface.
enum class Request : std::uint8_t { Capabilities = 1, Arm = 2, Disarm = 3, Home = 4, FaultText = 5 };
constexpr std::uint8_t kRequestIn = 0xc1, kRequestOut = 0x41;

constexpr std::size_t kCapabilitiesSize = 64, kPoseSize = 64, kWrenchSize = 32, kFaultTextSize = 64;

/// Abilities and limits that a device states.
struct Capabilities {
  std::uint8_t major = kMajorVersion, minor = 0;
  bool sensesOrientation = true, rendersTorque = true, hasDeadMan = false, needsHoming = false;
  std::uint8_t buttonCount = 0;
  std::uint16_t rate = 1000;         ///< Pose reports per second [Hz].
  std::uint16_t watchdogMs = 20;     ///< Without a wrench for this long it stops pushing and disarms [ms].
  float maxForce = 0.0F;             ///< [N]
  float maxTorque = 0.0F;            ///< [N m]
  float damping = 0.0F;              ///< Physical damping [N s/m].
  float rotationalDamping = 0.0F;    ///< [N m s/rad]
  float mass = 0.0F;                 ///< Mass of the moving parts as felt at the handle [kg].
  float inertia = 0.0F;              ///< [kg m^2]
  std::array<float, 3> workspace{};  ///< Half extents about the origin [m].
  float maxSpeed = 0.0F;             ///< Above this speed it brakes and faults by itself [m/s]; 0: never.
  bool operator==(const Capabilities&) const = default;
};

/// Bits of PoseReport::status.
enum PoseStatus : std::uint8_t {
  kHomed = 1,
  kDeadManHeld = 2,
  kFaulted = 4,
  kWatchdogTripped = 8,
  kArmed = 16,
};

/// A pose from the device, in its own frame.
struct PoseReport {
  std::uint8_t status = 0;          ///< PoseStatus bits.
  std::uint16_t sequence = 0;       ///< Rises by one with each report; wraps.
  std::uint32_t microseconds = 0;   ///< Device clock when the pose was measured [us]; wraps.
  std::array<float, 3> position{};  ///< [m]
  std::array<float, 4> rotation{1.0F, 0.0F, 0.0F, 0.0F};  ///< Unit quaternion w x y z.
  std::array<float, 3> velocity{};                        ///< [m/s]
  std::array<float, 3> angularVelocity{};                 ///< [rad/s]
  std::uint16_t buttons = 0;
  bool operator==(const PoseReport&) const = default;
};

enum WrenchFlags : std::uint8_t { kForcesOn = 1 };

/// A wrench for the device.
struct WrenchReport {
  std::uint8_t flags = 0;          ///< WrenchFlags bits.
  std::uint16_t sequence = 0;      ///< `sequence` of the pose that it answers.
  std::array<float, 3> force{};    ///< On the handle, in the device's frame [N].
  std::array<float, 3> torque{};   ///< About the handle's origin [N m].
  std::uint16_t timeToLiveMs = 0;  ///< Without a newer wrench for this long, forces go to zero.
  bool operator==(const WrenchReport&) const = default;
};

/// CRC-16/CCITT-FALSE.
std::uint16_t crc16(std::span<const std::byte> bytes) noexcept;

std::array<std::byte, kCapabilitiesSize> encode(const Capabilities& capabilities) noexcept;
std::array<std::byte, kPoseSize> encode(const PoseReport& report) noexcept;
std::array<std::byte, kWrenchSize> encode(const WrenchReport& report) noexcept;

/// Reasons for rejecting a message.
enum class Reject : std::uint8_t { None, Size, Kind, Checksum, Version, NotFinite, NotUnit, OutOfRange };

/// Decode a message and trust nothing in it: size, kind and checksum must be right, every number finite and
/// in range, the quaternion unit within kQuaternionSlack. If the result is not None, the output is unchanged.
Reject decode(std::span<const std::byte> bytes, Capabilities& capabilities) noexcept;
Reject decode(std::span<const std::byte> bytes, PoseReport& report) noexcept;
Reject decode(std::span<const std::byte> bytes, WrenchReport& report) noexcept;

/// Returns a fault text up to its first zero byte, with '?' for unprintable characters: terminals and windows
/// show it. Allocates.
std::string textOf(std::span<const std::byte> bytes);

/// Allows for rounding of four floats and for imprecise firmware arithmetic.
constexpr float kQuaternionSlack = 1e-2F;

}  // namespace nearfit::openhap
