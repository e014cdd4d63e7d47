#pragma once

#include <memory>
#include <string>

#include "core/realtime/latency_histogram.h"
#include "core/servo/motion_recording.h"
#include "core/servo/servo_tick.h"
#include "device/interface/haptic_device.h"

namespace nearfit {

/// Timing of a servo since its start; trivially copyable.
struct ServoStatistics {
  LatencyHistogram lateness;  ///< Wake-up after its deadline, or after the report that it follows.
  LatencyHistogram tickTime;  ///< Work in a tick, from reading the pose to showing the result.
  /// From a report's arrival to the wrench that answers it, if reports pace the servo.
  LatencyHistogram roundTrip;
  LatencyHistogram queryTime;    ///< Proximity queries in a tick.
  LatencyHistogram refreshTime;  ///< Each search of the thread that searches ahead.
  double reportInterval = 0.0;   ///< Recent mean, if reports pace the servo [s]; else 0.
  double reportJitter = 0.0;     ///< Mean deviation of the interval from its mean [s].
  std::uint64_t ticks = 0;
  /// Ticks that searched for themselves because the search thread lagged behind the motion.
  std::uint64_t lateTicks = 0;
  std::uint64_t overruns = 0;  ///< Ticks skipped because the one before ended too late.
};

/// Ticks a device against a scene in its own thread: at each report if the device sends them at a rate, else
/// at a fixed rate on absolute deadlines. Call it from one controlling thread. The servo thread allocates
/// nothing, locks nothing, throws nothing.
class ServoLoop {
 public:
  static constexpr double kPeriod = 1e-3;  ///< [s]: 1 kHz, the rate at which stiff contact feels hard.

  ServoLoop();
  ~ServoLoop();
  ServoLoop(const ServoLoop&) = delete;
  ServoLoop& operator=(const ServoLoop&) = delete;

  /// Starts the device and the ticking. The caller keeps the device alive until stop(). Forces are clamped to
  /// the lower of the device's limits and those of `parameters`. Throws UsageError (already running, no
  /// scene), Error (from the device, or no thread available).
  /// @param record  Receives a row of every tick until stop(), in order, and counts the rows that find it
  ///                full; may be null.
  void start(HapticDevice& device, std::unique_ptr<const ServoScene> scene, const ServoParameters& parameters,
             MotionQueue* record = nullptr);
  /// Like start(), with a device that is already open and stays open after stop(). For callers that open and
  /// close it on a thread that may wait.
  void startWithOpen(HapticDevice& device, std::unique_ptr<const ServoScene> scene,
                     const ServoParameters& parameters, MotionQueue* record = nullptr);
  /// Stops within a tick or two: sends a zero wrench last and stops the device if start() started it. No-op
  /// while stopped. Snapshot, statistics and note stay readable until the next start().
  void stop() noexcept;
  /// True while the servo ticks; false also once the device has ended by itself, when stop() is still due.
  bool isRunning() const noexcept;

  /// Replaces the scene once the search thread has searched it: in a few milliseconds. The old scene is freed
  /// later, off the servo thread. No-op while stopped. Throws UsageError if `scene` is null.
  void setScene(std::unique_ptr<const ServoScene> scene);
  /// Applies from the next tick on.
  void setParameters(const ServoParameters& parameters);
  /// While on, the part stays and nothing is felt: the hand repositions the device, as with the device's own
  /// clutch button. Off after each start.
  void setClutched(bool isClutched);

  /// Takes the newest snapshot. Returns true if there is one since the last call. One reader.
  bool pollSnapshot();
  /// Returns what the last pollSnapshot() took; valid until the next one, or the next start().
  const ServoSnapshot& snapshot() const noexcept;
  /// Returns statistics that are at most a tenth of a second old; after stop(), of all ticks.
  ServoStatistics statistics() const;
  /// Returns the real-time service granted ("SCHED_FIFO 70, memory locked"), or why not and the remedy.
  std::string schedulingNote() const;

 private:
  struct Shared;
  void requireStartable(const ServoScene* scene) const;
  std::unique_ptr<Shared> shared_;
};

}  // namespace nearfit
