#pragma once

#include <cstdint>
#include <string>

#include "core/haptics/device_limits.h"
#include "core/haptics/handle_input.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"
#include "core/progress.h"

namespace nearfit {

enum class DeviceState : std::uint8_t {
  Absent,        ///< Not plugged in any more when it was to be opened.
  Present,       ///< Plugged in, not open.
  Opening,       ///< Being opened, its firmware or capabilities fetched.
  Uncalibrated,  ///< Open, but it does not know where its handle is.
  Ready,         ///< Poses can be read; no force.
  Armed,         ///< Forces go out. Never without arm(), and never again by itself.
  Fault,         ///< Stopped for a reason that stateNote() tells; no force.
  Lost,          ///< Unplugged while open.
};

/// The slew limits of a device that bears so much: full force, and full torque, in 5 ms, as DeviceLimits has
/// it.
inline void limitSlewByMost(DeviceLimits& limits) noexcept {
  constexpr double kTimeToFull = 5e-3;
  limits.forceSlew = limits.maxForce / kTimeToFull;
  limits.torqueSlew = limits.maxTorque / kTimeToFull;
}

struct DeviceInfo {
  std::string name;
  int forceAxes = 0;  ///< 0, 3 or 6.
  DeviceLimits limits;
  double reportPeriod = 0.0;  ///< Of its reports, that the servo follows [s]; 0: the servo sets the pace.
  bool isMapped = true;       ///< False: its poses are the handle's own, for no workspace mapping to change.
};

/// Reports of a device since it was made.
struct ReportCounters {
  std::uint64_t poses = 0;     ///< Taken.
  std::uint64_t rejected = 0;  ///< Of another size, damaged, or with numbers that are none.
  std::uint64_t missing = 0;   ///< By their sequence numbers, where the device has such.
};

/// Something that a hand holds: gives the pose that the hand wants for the moving part, takes the wrench.
/// `waitForHandle`, `readHandle` and `sendWrench` on the servo thread, real-time safe; `state` and
/// `counters` on any; the rest on the controlling thread, but that `info` and `stateNote` may be called
/// beside all but `start` and `stop`. Every driver implements every call: there are no
/// defaults to fall into (PassiveDevice has some for those who choose them).
class HapticDevice {
 public:
  virtual ~HapticDevice() = default;

  virtual DeviceInfo info() const = 0;
  virtual DeviceState state() const noexcept = 0;
  /// Why it cannot be used, or what it waits for, as a sentence without a full stop; empty when there is
  /// nothing to say.
  virtual std::string stateNote() const = 0;
  /// Zeros where it sends no reports.
  virtual ReportCounters counters() const noexcept = 0;
  /// Begins to give poses: Ready afterwards, or what keeps it from that.
  /// It may take seconds: `progress` is told how far it is, and ends it soon when it says so.
  /// @param worldFromPart  Where the moving part is now: poses are given from there. Throws Error, Cancelled.
  virtual void start(const RigidTransform& worldFromPart, const ProgressCallback& progress = {}) = 0;
  virtual void stop() noexcept = 0;
  /// Lets forces out, or no more. Those without force, and simulated hands, are armed by start(). Throws
  /// Error when it is not ready.
  virtual void arm() = 0;
  virtual void disarm() noexcept = 0;
  /// Its handle is held in its rest, or left free to find itself: from the next reports on it knows where it
  /// is. Nothing happens with devices that know, or see to that by themselves. Throws Error when it is not
  /// open, or armed.
  virtual void calibrate() = 0;
  /// Forgets a fault, which nothing else does while it is open: it is ready again, or uncalibrated, never
  /// armed; and stopped anew at once where what stopped it lasts. Nothing happens without a fault. Throws
  /// Error when it refuses.
  virtual void reset() = 0;

  /// Sleeps until there is a newer pose than the last that was read, or until `deadline`; true for the
  /// former. A device that the servo paces sleeps till the deadline.
  /// @param deadline  CLOCK_MONOTONIC [ns].
  virtual bool waitForHandle(std::int64_t deadline) noexcept = 0;

  /// The newest pose of the handle, from which the workspace mapping makes one in the world, and its age.
  /// False when the device has ended or been lost: `handle` is left as it was.
  virtual bool readHandle(HandleInput& handle) noexcept = 0;
  /// Takes a wrench that is finite and within the limits.
  virtual void sendWrench(const Wrench& wrench) noexcept = 0;
};

}  // namespace nearfit
