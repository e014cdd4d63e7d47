#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "core/haptics/servo_tick.h"
#include "core/realtime/latency_histogram.h"
#include "core/realtime/spsc_queue.h"
#include "core/realtime/triple_buffer.h"
#include "device/haptic_device.h"

namespace nearfit {

/// Timing of a servo since its start; trivially copyable.
struct ServoStatistics {
  LatencyHistogram lateness;   ///< Wake-up behind its deadline.
  LatencyHistogram tickTime;   ///< Work in a tick.
  LatencyHistogram queryTime;
  std::uint64_t ticks = 0;
  std::uint64_t overruns = 0;  ///< Ticks that were skipped because the one before took too long.
};

/// Ticks a device against a scene at a fixed rate on absolute deadlines, in a thread of its own.
/// All calls from one controlling thread. The servo thread allocates nothing, locks nothing, throws nothing.
class ServoLoop {
 public:
  static constexpr double kPeriod = 1e-3;  ///< [s]: 1 kHz, the rate at which stiff contact feels hard.

  ServoLoop();
  ~ServoLoop();
  ServoLoop(const ServoLoop&) = delete;
  ServoLoop& operator=(const ServoLoop&) = delete;

  /// Starts ticking. The device stays the caller's, alive until stop(). Throws UsageError, Error.
  void start(HapticDevice& device, std::unique_ptr<const ServoScene> scene, const ServoParameters& parameters);
  /// Stops within a tick or two; sends a zero wrench last. Harmless when stopped.
  void stop() noexcept;
  /// False also once the device has ended by itself.
  bool isRunning() const noexcept;

  /// Puts another scene in place at the next tick; the old one is freed on this thread, later.
  void setScene(std::unique_ptr<const ServoScene> scene);
  void setParameters(const ServoParameters& parameters);

  /// The newest snapshot; true when it is another than at the last call. One reader.
  bool pollSnapshot();
  const ServoSnapshot& snapshot() const noexcept;
  /// Copies the statistics as of the last tick or so.
  ServoStatistics statistics() const;
  /// What real-time service the system granted ("SCHED_FIFO 70, memory locked", or why not), for the user.
  std::string schedulingNote() const;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace nearfit
