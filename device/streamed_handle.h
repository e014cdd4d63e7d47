#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "core/realtime/triple_buffer.h"
#include "device/device_supervisor.h"
#include "device/haptic_device.h"
#include "device/servo/monotonic_clock.h"
#include "device/usb/usb_link.h"

namespace nearfit {

/// What drivers of devices that stream their poses share: the newest report on its way from the link's thread
/// to the servo's, its age, the end of waiting for it, the supervisor, counts, and how the device was lost.
///
/// @tparam Report  What a driver makes of a packet; trivially copyable.
template <class Report>
class StreamedHandle {
 public:
  DeviceSupervisor& supervisor() noexcept { return supervisor_; }
  const DeviceSupervisor& supervisor() const noexcept { return supervisor_; }
  DeviceState state() const noexcept { return supervisor_.state(); }
  /// HapticDevice::stateNote.
  /// @param uncalibrated  What it waits for when it is that.
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
  ReportCounters counters() const noexcept {
    return {poses_.load(std::memory_order_acquire), rejected_.load(std::memory_order_relaxed),
            missing_.load(std::memory_order_relaxed)};
  }

  /// Controlling thread, while nothing streams: forgets the last stream; its silence counts from now.
  /// @param initial  What the servo reads until something comes.
  void begin(const Report& initial) noexcept {
    loss_.store(UsbLoss::None, std::memory_order_release);
    rejectedInRow_ = 0;
    samples_.publish(Sample{initial, monotonicNow(), false});
    samples_.update();
  }

  /// The link's thread: where the next report goes; its content is some old one.
  Report& next() noexcept { return samples_.back().report; }
  /// The link's thread: next() is filled.
  void publish(Nanoseconds arrived) noexcept {
    rejectedInRow_ = 0;
    samples_.back().arrived = arrived;
    samples_.back().isReal = true;
    samples_.publish();
    // Counted last: who sees that it was counted finds it with update().
    poses_.fetch_add(1, std::memory_order_release);
    newPose_.ring();
  }
  /// The link's thread: a packet cannot be used. kMostRejectedInRow in a row stop the device.
  void reject(DeviceFault fault = DeviceFault::Garbage) noexcept {
    rejected_.fetch_add(1, std::memory_order_relaxed);
    if (++rejectedInRow_ == kMostRejectedInRow) supervisor_.stop(fault);
  }
  void countMissing(std::uint64_t count) noexcept { missing_.fetch_add(count, std::memory_order_relaxed); }
  /// The link's thread: UsbPacketSink::onLost.
  void lose(UsbLoss loss) noexcept {
    loss_.store(loss, std::memory_order_release);
    supervisor_.lost();
    newPose_.ring();
  }

  /// Servo thread: HapticDevice::waitForHandle.
  bool wait(Nanoseconds deadline) noexcept { return newPose_.wait(deadline); }
  /// Servo thread: takes the newest over; false when the device is lost.
  bool update() noexcept {
    samples_.update();
    return state() != DeviceState::Lost;
  }
  /// Servo thread: what the last update took.
  const Report& report() const noexcept { return samples_.front().report; }
  /// Servo thread: false as long as report() is the initial one.
  bool hasReport() const noexcept { return samples_.front().isReal; }
  /// Servo thread: of report() [s].
  double age() const noexcept { return toSeconds(monotonicNow() - samples_.front().arrived); }

  /// A damaged report now and then happens on long cables; so many in a row are no device of ours.
  static constexpr unsigned kMostRejectedInRow = 20;

 private:
  struct Sample {
    Report report;
    Nanoseconds arrived = 0;
    bool isReal = false;  ///< It came from the device.
  };

  DeviceSupervisor supervisor_;
  std::atomic<UsbLoss> loss_{UsbLoss::None};
  TripleBuffer<Sample> samples_;
  WakeSignal newPose_;
  std::atomic<std::uint64_t> poses_{0}, rejected_{0}, missing_{0};
  unsigned rejectedInRow_ = 0;  ///< The link thread's own.
};

}  // namespace nearfit
