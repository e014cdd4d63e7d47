#pragma once

#include <cstdint>

#include "core/realtime/latency_histogram.h"
#include "device/haptic_device.h"
#include "device/servo/monotonic_clock.h"
#include "device/servo/realtime_thread.h"

namespace nearfit::cli {

/// How often reports come, by a device's own count of them and when they are seen.
class ReportMeter {
 public:
  /// @param poses    ReportCounters::poses.
  /// @param arrived  Of the newest, as nearly as is known.
  void see(std::uint64_t poses, Nanoseconds arrived) noexcept;

  /// Reports a second between the last two calls [Hz]; 0 in the first.
  double takeRate(Nanoseconds now) noexcept;
  /// Between reports that were seen [s]; pauses are left out.
  const LatencyHistogram& intervals() const noexcept { return intervals_; }
  std::uint64_t poses() const noexcept { return poses_; }

  /// A cap at rest sends nothing: longer is no jitter.
  static constexpr Nanoseconds kPause = kNanosecondsPerSecond / 10;

 private:
  LatencyHistogram intervals_;
  std::uint64_t poses_ = 0, posesTaken_ = 0;
  Nanoseconds lastArrived_ = 0, taken_ = 0;
};

/// A device that is open and that this thread serves, with real-time service where that is granted: for
/// looking at it without a scene. Its forces are off and it is closed when this ends.
class TickedDevice {
 public:
  /// Opens it, and calibrates it where that is wished. Throws Error.
  TickedDevice(HapticDevice& device, bool isCalibrating);
  ~TickedDevice();
  TickedDevice(const TickedDevice&) = delete;
  TickedDevice& operator=(const TickedDevice&) = delete;

  /// Waits for the next report or period, reads the handle, answers with the wrench (which goes out only when
  /// the device is armed). False when it has been lost.
  bool tick(const Wrench& wrench = {}) noexcept;
  /// As of the last tick.
  const HandleInput& handle() const noexcept { return handle_; }

  HapticDevice& device() noexcept { return device_; }
  ReportMeter& meter() noexcept { return meter_; }
  const ReportMeter& meter() const noexcept { return meter_; }
  const RealtimeGrant& grant() const noexcept { return grant_; }

 private:
  HapticDevice& device_;
  Nanoseconds patience_ = kNanosecondsPerSecond / 1000;  ///< For the next report; or the period.
  HandleInput handle_;
  ReportMeter meter_;
  RealtimeGrant grant_;
};

}  // namespace nearfit::cli
