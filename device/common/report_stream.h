#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "core/realtime/triple_buffer.h"
#include "device/interface/device_supervisor.h"
#include "device/interface/haptic_device.h"
#include "device/thread/monotonic_clock.h"
#include "device/usb/usb_link.h"

namespace nearfit {

/// The reports of a device that streams poses, shared by such drivers: passes the newest from the link's thread
/// to the servo thread and wakes it. Holds the report's age, the supervisor, the counters and the reason for a
/// loss.
///
/// @tparam Report  Decoded packet; trivially copyable.
template <class Report>
class ReportStream {
 public:
  DeviceSupervisor& supervisor() noexcept { return supervisor_; }
  const DeviceSupervisor& supervisor() const noexcept { return supervisor_; }
  DeviceState state() const noexcept { return supervisor_.state(); }
  /// Implements HapticDevice::stateNote().
  /// @param uncalibrated  Text for the state Uncalibrated.
  std::string note(const char* uncalibrated) const {
    switch (state()) {
      case DeviceState::Fault:
        return faultReason(supervisor_.fault());
      case DeviceState::Lost:
        return lossReason(loss_.load(std::memory_order_acquire));
      case DeviceState::Uncalibrated:
        return uncalibrated;
      default:
        return {};
    }
  }
  /// Any thread.
  ReportCounters counters() const noexcept {
    return {poses_.load(std::memory_order_acquire), rejected_.load(std::memory_order_relaxed),
            missing_.load(std::memory_order_relaxed)};
  }

  /// Controlling thread, while nothing streams: forgets the last stream. Silence counts from now.
  /// @param initial  Report that the servo reads until the first one arrives.
  void begin(const Report& initial) noexcept {
    loss_.store(UsbLoss::None, std::memory_order_release);
    rejectedInRow_ = 0;
    samples_.publish(Sample{initial, monotonicNow(), false});
    samples_.update();
  }

  /// Link's thread: storage for the next report; it holds an old one.
  Report& next() noexcept { return samples_.back().report; }
  /// Link's thread: passes next() on.
  /// @param arrived  Arrival on CLOCK_MONOTONIC [ns].
  void publish(Nanoseconds arrived) noexcept {
    rejectedInRow_ = 0;
    samples_.back().arrived = arrived;
    samples_.back().isReal = true;
    samples_.publish();
    // Counted last, so that whoever sees the count finds the report with update().
    poses_.fetch_add(1, std::memory_order_release);
    newPose_.ring();
  }
  /// Link's thread: counts an unusable packet. kMaxRejectedInRow in a row stop the device with `fault`.
  void reject(DeviceFault fault = DeviceFault::Garbage) noexcept {
    rejected_.fetch_add(1, std::memory_order_relaxed);
    if (++rejectedInRow_ == kMaxRejectedInRow) supervisor_.stop(fault);
  }
  /// Any thread: counts reports that never arrived.
  void countMissing(std::uint64_t count) noexcept { missing_.fetch_add(count, std::memory_order_relaxed); }
  /// Link's thread: implements UsbPacketSink::onLost().
  void lose(UsbLoss loss) noexcept {
    loss_.store(loss, std::memory_order_release);
    supervisor_.lost();
    newPose_.ring();
  }

  /// Servo thread: implements HapticDevice::waitForHandle().
  bool wait(Nanoseconds deadline) noexcept { return newPose_.wait(deadline); }
  /// Servo thread: takes the newest report. Returns false if the device is lost.
  bool update() noexcept {
    samples_.update();
    return state() != DeviceState::Lost;
  }
  /// Servo thread: the report that update() took last.
  const Report& report() const noexcept { return samples_.front().report; }
  /// Servo thread: false while report() is the initial one.
  bool hasReport() const noexcept { return samples_.front().isReal; }
  /// Servo thread: age of report() [s].
  double age() const noexcept { return toSeconds(monotonicNow() - samples_.front().arrived); }

  /// Long cables damage a report now and then; this many in a row come from another kind of device.
  static constexpr unsigned kMaxRejectedInRow = 20;

 private:
  struct Sample {
    Report report;
    Nanoseconds arrived = 0;
    bool isReal = false;  ///< Came from the device.
  };

  DeviceSupervisor supervisor_;
  std::atomic<UsbLoss> loss_{UsbLoss::None};
  TripleBuffer<Sample> samples_;
  WakeSignal newPose_;
  std::atomic<std::uint64_t> poses_{0}, rejected_{0}, missing_{0};
  unsigned rejectedInRow_ = 0;  ///< Link's thread only.
};

}  // namespace nearfit
