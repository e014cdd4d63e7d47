#pragma once

#include <atomic>
#include <thread>

#include "device/interface/haptic_device.h"

namespace nearfit::test {

/// Waits for a report and reads it. False when none comes within kPatience, or the device is lost.
bool takeReport(HapticDevice& device, HandleInput& handle);

/// Plays the servo on the caller's thread: takes so many reports and answers each with the wrench.
///
/// Of a device that answers commands, what the last one brings is on its way afterwards; takeReport() takes
/// that, and then nothing is.
/// @param handle  The last that was read.
bool serve(HapticDevice& device, int reports, const Wrench& wrench, HandleInput& handle);

/// Plays the servo on a thread of its own, from now on: answers each report, and silence, with one wrench.
class SteadyServo {
 public:
  SteadyServo(HapticDevice& device, const Wrench& wrench);
  ~SteadyServo() { stop(); }
  SteadyServo(const SteadyServo&) = delete;
  SteadyServo& operator=(const SteadyServo&) = delete;

  bool hasRead() const { return hasRead_.load(); }
  bool hasEnded() const { return hasEnded_.load(); }
  /// The last that it read.
  HandleInput stop();

 private:
  HandleInput last_;
  std::atomic<bool> isStopping_{false}, hasRead_{false}, hasEnded_{false};
  std::thread thread_;
};

}  // namespace nearfit::test
