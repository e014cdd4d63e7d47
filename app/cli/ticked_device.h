#pragma once

#include <cstdint>

#include "core/realtime/latency_histogram.h"
#include "device/interface/haptic_device.h"
#include "device/thread/monotonic_clock.h"
#include "device/thread/realtime_thread.h"

namespace nearfit::cli {

/// Measures how often reports come, from the device's own count and the times at which they are seen.
class ReportMeter {
 public:
  /// @param poses    ReportCounters::poses.
  /// @param arrived  Arrival of the newest report, as nearly as it is known.
  void see(std::uint64_t poses, Nanoseconds arrived) noexcept;

  /// Returns the reports per second between the last two calls [Hz]; 0 at the first.
  double takeRate(Nanoseconds now) noexcept;
  /// Returns the times between reports that were seen [s], without pauses.
  const LatencyHistogram& intervals() const noexcept { return intervals_; }
  std::uint64_t poses() const noexcept { return poses_; }

  /// A longer interval is no jitter but a pause: a cap at rest sends nothing.
  static constexpr Nanoseconds kPause = kNanosecondsPerSecond / 10;

 private:
  LatencyHistogram intervals_;
  std::uint64_t poses_ = 0, posesTaken_ = 0;
  Nanoseconds lastArrived_ = 0, taken_ = 0;
};

/// An open device that this thread ticks, with real-time service if granted: for watching a device without a
/// scene. At the end its forces are turned off and it is closed.
class TickedDevice {
 public:
  /// Opens the device, and calibrates it if wanted. Throws Error.
  TickedDevice(HapticDevice& device, bool isCalibrating);
  ~TickedDevice();
  TickedDevice(const TickedDevice&) = delete;
  TickedDevice& operator=(const TickedDevice&) = delete;

  /// Waits for the next report or period, reads the handle and answers with the wrench, which goes out only
  /// if the device is armed. Returns false if the device is lost.
  bool tick(const Wrench& wrench = {}) noexcept;
  /// The handle at the last tick.
  const HandleInput& handle() const noexcept { return handle_; }

  HapticDevice& device() noexcept { return device_; }
  ReportMeter& meter() noexcept { return meter_; }
  const ReportMeter& meter() const noexcept { return meter_; }
  const RealtimeGrant& grant() const noexcept { return grant_; }

 private:
  HapticDevice& device_;
  Nanoseconds patience_ = kNanosecondsPerSecond / 1000;  ///< Longest wait for a report; or the period.
  HandleInput handle_;
  ReportMeter meter_;
  RealtimeGrant grant_;
};

}  // namespace nearfit::cli
