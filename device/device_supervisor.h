#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>

#include <glm/vec3.hpp>

#include "device/haptic_device.h"

namespace nearfit {

/// Why a device was stopped.
enum class DeviceFault : std::uint8_t {
  None,
  Silent,      ///< No pose for longer than SafetyLimits::patience allows.
  TooFast,     ///< Faster than SafetyLimits::faultSpeed.
  Reported,    ///< It says so itself.
  Garbage,     ///< What it sends cannot be read.
  OutOfReach,  ///< Its joints are where they cannot be: its calibration is wrong.
};

/// As a sentence without a full stop; empty for None.
const char* faultReason(DeviceFault fault) noexcept;

/// What a device is that could not be opened: Absent when it was gone, else Present. In a catch block alone.
DeviceState stateAfterFailure() noexcept;

/// When a device is stopped, and what slows it down before.
struct SafetyLimits {
  PosePatience patience;  ///< Without a pose forces fade from `hold` on; at `silence` it is stopped.
  double brakeSpeed =
      1.0;  ///< Beyond this the handle is braked [m/s]: a hand is seldom faster, a runaway is.
  double brakeDamping = 5.0;  ///< By so much for each metre a second beyond [N s/m].
  double faultSpeed = 3.0;    ///< Beyond this it is stopped [m/s].
  bool hasDeadMan = false;    ///< Forces only while the hand holds its switch.

  /// A device that is slow by its nature is not silent between two of its reports: one may be late, or lost.
  /// @param reportPeriod  Of its reports [s].
  void keepPace(double reportPeriod) noexcept {
    constexpr double kHoldPeriods = 2.0, kSilentPeriods = 4.0;
    patience.hold = std::fmax(patience.hold, kHoldPeriods * reportPeriod);
    patience.silence = std::fmax(patience.silence, kSilentPeriods * reportPeriod);
  }

  /// Stops at no more than the speed that a device itself allows [m/s], 0 for any, and brakes well before.
  void keepBelow(double maxSpeed) noexcept {
    if (maxSpeed > 0.0 && maxSpeed < faultSpeed) faultSpeed = maxSpeed;
    if (brakeSpeed > 0.5 * faultSpeed) brakeSpeed = 0.5 * faultSpeed;
  }
};

/// The state of a device that is plugged in, and what may go out to it: forces only when armed, and never
/// armed but by arm(). Holds no thread and no clock. Each call says whose it is; all but those of the
/// controlling thread are real-time safe.
class DeviceSupervisor {
 public:
  DeviceState state() const noexcept { return state_.load(std::memory_order_acquire); }
  DeviceFault fault() const noexcept { return fault_.load(std::memory_order_acquire); }

  /// Controlling thread.
  void beginOpening() noexcept;
  void opened(const SafetyLimits& limits, bool isCalibrated) noexcept;
  void closed(DeviceState state) noexcept;
  /// Throws DeviceError when it is not ready, and says what it waits for. Harmless when armed.
  void arm(const std::string& device);
  /// Throws DeviceError unless it is open, whole and not armed: a pose that jumps must not push.
  void requireCalibratable(const std::string& device) const;
  /// Forgets a fault: the device is ready again, or uncalibrated where it was that or proved to be.
  void reset() noexcept;

  /// Any thread.
  void disarm() noexcept;
  void calibrated() noexcept;
  void lost() noexcept;
  /// The first reason stays.
  void stop(DeviceFault fault) noexcept;

  struct Sample {
    double age = 0.0;    ///< Of the newest pose [s].
    double speed = 0.0;  ///< Of the handle, in the device's own metres [m/s].
    bool isDeadManHeld = false;
  };
  /// Servo thread, each tick: stops the device where it must be. True when forces may go out.
  bool check(const Sample& sample) noexcept;

  /// Servo thread.
  const PosePatience& patience() const noexcept { return limits_.patience; }

  /// Servo thread: `wrench` with the brake, or none at all when no force may go out.
  /// @param velocity  Of the handle [m/s].
  Wrench guarded(const Wrench& wrench, const glm::dvec3& velocity, double maxForce) const noexcept;

 private:
  bool change(DeviceState from, DeviceState to) noexcept;

  std::atomic<DeviceState> state_{DeviceState::Present};
  std::atomic<DeviceFault> fault_{DeviceFault::None};
  std::atomic<bool> isCalibrated_{false};
  SafetyLimits limits_;        ///< Written while nothing streams.
  bool areForcesOut_ = false;  ///< The servo thread's: as of the last check.
};

}  // namespace nearfit
