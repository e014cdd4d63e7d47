#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

#include "device/thread/monotonic_clock.h"
#include "tests/usb/emulated_device.h"

namespace nearfit::test {

/// Without the spinning of waitUntil(): a device costs the machine nothing.
void sleepUntil(Nanoseconds due);

/// Reports that an emulated device sends at a rate, from a thread of its own under SCHED_FIFO where granted,
/// until there were enough, the device is unplugged, or it is told to stop.
class ReportStream {
 public:
  struct Plan {
    std::uint8_t endpoint = 0x81;
    double rate = 1000.0;                                ///< [Hz]
    std::uint64_t count = 0;                             ///< 0: without end.
    std::function<Bytes(std::uint64_t)> report;          ///< The n-th, when it is due.
    std::function<bool(std::uint64_t)> mayGo = nullptr;  ///< The n-th; it waits for that, where it is given.
    bool isPatient = false;  ///< Waits for a host as long as there is none, instead of losing the report.
  };
  /// Starts at once. `device` outlives this.
  ReportStream(EmulatedDevice& device, Plan plan);
  ~ReportStream() { stop(); }
  ReportStream(const ReportStream&) = delete;
  ReportStream& operator=(const ReportStream&) = delete;

  /// Waits for the last report.
  void join();
  void stop();

  struct Counts {
    std::uint64_t sent = 0;
    std::uint64_t waited = 0;   ///< Of those: that the host's thread had not asked for when they were due.
    std::uint64_t delayed = 0;  ///< Of those: that waited until they might go.
    std::uint64_t lost = 0;     ///< That nobody asked for, however long they waited.
  };
  Counts counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  void run();
  bool waitToGo(std::uint64_t report);
  void count(std::uint64_t Counts::* what);
  bool send(const Bytes& report);

  EmulatedDevice& device_;
  const Plan plan_;
  mutable std::mutex mutex_;
  Counts counts_;
  std::atomic<bool> isStopping_{false};
  std::thread thread_;
};

}  // namespace nearfit::test
