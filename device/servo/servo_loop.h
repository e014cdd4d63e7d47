#pragma once

#include <memory>
#include <string>

#include "core/haptics/servo_tick.h"
#include "core/realtime/latency_histogram.h"
#include "core/scene/motion_recording.h"
#include "device/haptic_device.h"

namespace nearfit {

/// Timing of a servo since its start; trivially copyable.
struct ServoStatistics {
  LatencyHistogram lateness;   ///< Wake-up behind its deadline, or behind the report that it follows.
  LatencyHistogram tickTime;   ///< Work in a tick, from the device's pose to what is shown of it.
  LatencyHistogram roundTrip;  ///< From a report's arrival to its wrench handed over, where reports pace it.
  LatencyHistogram queryTime;
  LatencyHistogram refreshTime;  ///< Of the thread beside that searches ahead, a time a search.
  double reportInterval = 0.0;   ///< Of late, where reports pace it [s]; else 0.
  double reportJitter = 0.0;     ///< Mean distance of that from its mean [s].
  std::uint64_t ticks = 0;
  /// Ticks that searched for themselves, as the thread beside had not caught up with the motion.
  std::uint64_t lateTicks = 0;
  std::uint64_t overruns = 0;  ///< Ticks that were skipped because the one before ended too late.
};

/// Ticks a device against a scene in a thread of its own: at each of its reports where it sends them at a
/// rate, else at a fixed rate on absolute deadlines. All calls from one controlling thread. The servo thread
/// allocates nothing, locks nothing, throws nothing.
class ServoLoop {
 public:
  static constexpr double kPeriod = 1e-3;  ///< [s]: 1 kHz, the rate at which stiff contact feels hard.

  ServoLoop();
  ~ServoLoop();
  ServoLoop(const ServoLoop&) = delete;
  ServoLoop& operator=(const ServoLoop&) = delete;

  /// Starts the device and the ticking. The device stays the caller's, alive until stop(); forces are clamped
  /// to its limits and to those of `parameters`, whichever are lower.
  /// @param record  Takes a row of every tick until stop(), in order; counts what finds it full. May be null.
  /// Throws UsageError (running already, no scene), Error (from the device, or no thread to be had).
  void start(HapticDevice& device, std::unique_ptr<const ServoScene> scene, const ServoParameters& parameters,
             MotionQueue* record = nullptr);
  /// The same with a device that is open already, and stays open when this stops: others open and close it,
  /// who can wait.
  void startWithOpen(HapticDevice& device, std::unique_ptr<const ServoScene> scene,
                     const ServoParameters& parameters, MotionQueue* record = nullptr);
  /// Stops within a tick or two; sends a zero wrench last, stops the device. Harmless when stopped. Snapshot,
  /// statistics and note stay readable until the next start().
  void stop() noexcept;
  /// False also once the device has ended by itself; stop() is due then too.
  bool isRunning() const noexcept;

  /// Puts another scene in place, once the thread beside the servo has searched it: a few milliseconds. The
  /// old one is freed off the servo thread, later. Throws UsageError when `scene` is null.
  void setScene(std::unique_ptr<const ServoScene> scene);
  void setParameters(const ServoParameters& parameters);
  /// While it is on, the part stays and nothing is felt: the hand brings the device elsewhere, as by a clutch
  /// button that the device may have besides. Off after each start.
  void setClutched(bool isClutched);

  /// The newest snapshot; true when it is another than at the last call. One reader.
  bool pollSnapshot();
  /// What the last pollSnapshot() took; valid until the next one, or the next start().
  const ServoSnapshot& snapshot() const noexcept;
  /// Copies the statistics as of a tenth of a second ago at most; after stop(), of all ticks.
  ServoStatistics statistics() const;
  /// What real-time service the system granted ("SCHED_FIFO 70, memory locked", or why not and the remedy).
  std::string schedulingNote() const;

 private:
  struct Shared;
  void requireStartable(const ServoScene* scene) const;
  std::unique_ptr<Shared> shared_;
};

}  // namespace nearfit
