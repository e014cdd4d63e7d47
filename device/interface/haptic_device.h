#pragma once

#include <cstdint>
#include <string>

#include "core/base/progress.h"
#include "core/haptics/device_limits.h"
#include "core/haptics/handle_input.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// State of a device.
enum class DeviceState : std::uint8_t {
  Absent,        ///< Unplugged before it could be opened.
  Present,       ///< Plugged in, not open.
  Opening,       ///< Being opened: firmware is loaded, capabilities are read.
  Uncalibrated,  ///< Open, but the handle's pose is unknown.
  Ready,         ///< Poses can be read; forces are off.
  Armed,         ///< Forces go out. Entered by arm() alone, or by start() of a passive device.
  Fault,         ///< Stopped; stateNote() says why. Forces are off.
  Lost,          ///< Unplugged while open.
};

/// Sets the slew limits to full force and full torque in 5 ms, as DeviceLimits describes.
inline void limitSlewByMax(DeviceLimits& limits) noexcept {
  constexpr double kTimeToFull = 5e-3;
  limits.forceSlew = limits.maxForce / kTimeToFull;
  limits.torqueSlew = limits.maxTorque / kTimeToFull;
}

/// Properties of a device; some become known only when it is open.
struct DeviceInfo {
  std::string name;
  int forceAxes = 0;  ///< Axes that it can push along: 0, 3 (force) or 6 (force and torque).
  DeviceLimits limits;
  double reportPeriod = 0.0;  ///< Period of the reports that pace the servo [s]; 0: the servo sets the pace.
  bool isMapped = true;       ///< False: poses are final, and workspace mapping does not apply.
  int sensedAxes = 6;         ///< Axes that it senses: 3 (its handle does not turn, or unseen) or 6.
  double maxSpeed = 0.0;      ///< Above it the device is stopped [m/s]; 0: by SafetyLimits alone.

  /// True if the hand can turn it and feels nothing of what turning meets (HandleInput::isTorqueFelt).
  bool isTurningUnfelt() const noexcept { return sensedAxes == 6 && forceAxes == 3; }
};

/// Reports of a device since its driver was created.
struct ReportCounters {
  std::uint64_t poses = 0;     ///< Accepted.
  std::uint64_t rejected = 0;  ///< Wrong size, damaged or not finite.
  std::uint64_t missing = 0;   ///< Gaps in the sequence numbers, if the device has them.
};

/// A device held by a hand: gives the pose that the hand wants for the moving part, and takes the wrench.
///
/// Threads: `waitForHandle`, `readHandle` and `sendWrench` on the servo thread, real-time safe; `state` and
/// `counters` on any; the rest on the controlling thread. `info` and `stateNote` may also be called from
/// other threads, but not during `start` or `stop`. Every driver implements every call, since no default is
/// safe; PassiveDevice has no-ops for those that choose them.
class HapticDevice {
 public:
  virtual ~HapticDevice() = default;

  /// Returns name, limits and pace; complete once the device is open.
  virtual DeviceInfo info() const = 0;
  virtual DeviceState state() const noexcept = 0;
  /// Returns why it cannot be used or what it waits for, as a sentence without a full stop; may be empty.
  virtual std::string stateNote() const = 0;
  /// Returns zeros if it sends no reports.
  virtual ReportCounters counters() const noexcept = 0;
  /// Opens the device and begins to give poses: Ready afterwards (passive devices: Armed), or the state that
  /// prevents it. May take seconds; `progress` is called meanwhile and can cancel. Throws Error, Cancelled.
  /// @param worldFromPart  Pose of the moving part now, where poses begin.
  virtual void start(const RigidTransform& worldFromPart, const ProgressCallback& progress = {}) = 0;
  /// Turns forces off and closes the device; no-op while closed.
  virtual void stop() noexcept = 0;
  /// Turns forces on. Throws Error if the device is not ready. Devices without force and simulated hands
  /// are armed by start().
  virtual void arm() = 0;
  /// Turns forces off.
  virtual void disarm() noexcept = 0;
  /// Declares that the handle is in its rest pose, or free to home: its pose is known from the next
  /// reports on. No-op for devices that know it or calibrate by themselves. Throws Error if the device
  /// is closed or armed.
  virtual void calibrate() = 0;
  /// Clears a fault, which nothing else does while the device is open: Ready again, or Uncalibrated, never
  /// Armed. The device stops again at once if the cause persists. No-op without a fault. Throws Error if
  /// the device refuses.
  virtual void reset() = 0;

  /// Sleeps until a pose newer than the last one read arrives, and returns true; or until `deadline`, and
  /// returns false. With a device that the servo paces, always sleeps until the deadline.
  /// @param deadline  Time on CLOCK_MONOTONIC [ns].
  virtual bool waitForHandle(std::int64_t deadline) noexcept = 0;

  /// Reads the newest pose of the handle, in the device's frame, and its age. The workspace mapping turns it
  /// into a pose in the world. Returns false, and leaves `handle` alone, if the device has ended or is lost.
  virtual bool readHandle(HandleInput& handle) noexcept = 0;
  /// Sends the wrench to render, in the device's frame: finite and within the limits.
  virtual void sendWrench(const Wrench& wrench) noexcept = 0;
};

}  // namespace nearfit
