#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>

#include <glm/vec3.hpp>

#include "device/interface/haptic_device.h"

namespace nearfit {

/// Reasons for stopping a device.
enum class DeviceFault : std::uint8_t {
  None,
  Silent,       ///< No pose for SafetyLimits::patience.silence.
  TooFast,      ///< Faster than SafetyLimits::faultSpeed.
  Reported,     ///< Reported by the device itself.
  Garbage,      ///< Its reports cannot be decoded.
  OutOfReach,   ///< Its joint angles are impossible: the calibration is wrong.
  Hot,          ///< Its motors are too warm.
  Overloaded,   ///< More force was asked for than it can give.
  BrokenLink,   ///< Its connection is disturbed.
  SwitchedOff,  ///< Its forces were turned off at the device.
  PoseUnknown,  ///< It lost its calibration while it was armed.
};

/// Returns the reason as a sentence without a full stop; empty for None.
const char* faultReason(DeviceFault fault) noexcept;

/// Returns the state after opening failed: Absent if the device was gone, else Present. Call
/// only in a catch block.
DeviceState stateAfterFailure() noexcept;

/// When a device is braked, and when it is stopped.
struct SafetyLimits {
  PoseFade patience;  ///< Without a pose, forces fade from `hold` on; the device stops at `silence`.
  /// The handle is braked above this speed [m/s]: a hand is seldom faster, a runaway is.
  double brakeSpeed = 1.0;
  double brakeDamping = 5.0;  ///< Braking force per speed above brakeSpeed [N s/m].
  double faultSpeed = 3.0;    ///< The device stops above this speed [m/s].
  bool hasDeadMan = false;    ///< Forces go out only while the dead-man switch is held.

  /// Allows for a slow device, one of whose reports may be late or lost: raises `hold` to at least two report
  /// periods and `silence` to four.
  /// @param reportPeriod  Time between reports [s].
  void keepPace(double reportPeriod) noexcept {
    constexpr double kHoldPeriods = 2.0, kSilentPeriods = 4.0;
    patience.hold = std::fmax(patience.hold, kHoldPeriods * reportPeriod);
    patience.silence = std::fmax(patience.silence, kSilentPeriods * reportPeriod);
  }

  /// Lowers faultSpeed to the device's own `maxSpeed` [m/s] (0: none), and brakeSpeed to at most
  /// half of faultSpeed.
  void keepBelow(double maxSpeed) noexcept {
    if (maxSpeed > 0.0 && maxSpeed < faultSpeed) faultSpeed = maxSpeed;
    if (brakeSpeed > 0.5 * faultSpeed) brakeSpeed = 0.5 * faultSpeed;
  }
};

/// State of a plugged-in device, and the gate for its forces: they go out only while it is Armed, and only
/// arm() arms it. Has neither thread nor clock. Each member names the thread that may call it; all but those
/// of the controlling thread are real-time safe.
class DeviceSupervisor {
 public:
  DeviceState state() const noexcept { return state_.load(std::memory_order_acquire); }
  DeviceFault fault() const noexcept { return fault_.load(std::memory_order_acquire); }

  /// Controlling thread: begins to open the device and clears the last fault.
  void beginOpening() noexcept;
  /// Controlling thread, before streaming: leaves Opening for Ready, or for Uncalibrated. Lost stays Lost.
  void opened(const SafetyLimits& limits, bool isCalibrated) noexcept;
  /// Controlling thread: sets the state after closing.
  void closed(DeviceState state) noexcept;
  /// Controlling thread: arms a Ready device; no-op if it is armed. Otherwise throws DeviceError that says
  /// what the device waits for.
  /// @param device  Name for the message.
  void arm(const std::string& device);
  /// Controlling thread: throws DeviceError unless the device is Ready or Uncalibrated. Calibration makes the
  /// pose jump, which must not push.
  void requireCalibratable(const std::string& device) const;
  /// Controlling thread: clears a fault. The device is Ready again, or Uncalibrated if its calibration is
  /// missing or was wrong.
  void reset() noexcept;

  /// Any thread: disarms the device if it is armed.
  void disarm() noexcept;
  /// Any thread: the device knows its pose now; Uncalibrated becomes Ready.
  void calibrated() noexcept;
  /// Any thread: the device no longer knows its pose. Ready becomes Uncalibrated; an armed device is stopped, since a
  /// pose that is not known must not push, and is Uncalibrated once it is reset.
  void uncalibrated() noexcept;
  /// Any thread: the device is lost, whatever its state.
  void lost() noexcept;
  /// Any thread: stops an open device; the first fault is kept. OutOfReach also discards the calibration.
  void stop(DeviceFault fault) noexcept;

  struct Sample {
    double age = 0.0;    ///< Age of the newest pose [s].
    double speed = 0.0;  ///< Speed of the handle, before workspace scaling [m/s].
    bool isDeadManHeld = false;
  };
  /// Servo thread, each tick: stops an armed device that is silent or too fast. Returns true if
  /// forces may go out.
  bool check(const Sample& sample) noexcept;

  /// Servo thread: limits on the age of a pose.
  const PoseFade& patience() const noexcept { return limits_.patience; }

  /// Servo thread: returns `wrench`, with braking above brakeSpeed; zero if forces may not go out.
  /// @param velocity  Velocity of the handle [m/s].
  /// @param maxForce  Limit of the braked force [N].
  Wrench guarded(const Wrench& wrench, const glm::dvec3& velocity, double maxForce) const noexcept;

 private:
  bool change(DeviceState from, DeviceState to) noexcept;

  std::atomic<DeviceState> state_{DeviceState::Present};
  std::atomic<DeviceFault> fault_{DeviceFault::None};
  std::atomic<bool> isCalibrated_{false};
  SafetyLimits limits_;        ///< Written only while nothing streams.
  bool areForcesOut_ = false;  ///< Servo thread's: result of the last check().
};

}  // namespace nearfit
