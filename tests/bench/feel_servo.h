#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"
#include "tests/bench/bench_clock.h"

namespace nearfit::bench {

/// When a tick has what the thread beside the servo finds.
enum class ListArrival {
  AtOnce,  ///< In the next tick, however long the search took: the same on every machine.
  InTime,  ///< As in the servo: so many ticks later as the search took milliseconds, and half a one to wake.
};

/// The servo's tick with the thread beside it, which is played by the time between two ticks.
class FeelServo {
 public:
  /// @param parameters  Stay as they are.   @param clock  Of tickTime(), and of searches.
  FeelServo(std::shared_ptr<const ServoScene> scene, const ServoParameters& parameters, ListArrival arrival,
            BenchClock clock);

  /// One tick, and then what is done beside. Throws Error when the servo latches a fault, or when the part
  /// overlaps something: the figures would be void.
  const ServoSnapshot& tick(const RigidTransform& hand, double period);

  /// Of the last tick, without what is done beside [s].
  double tickTime() const noexcept { return tickTime_; }
  /// Whether the last tick lost its processor to another thread: times by the wall clock are then void.
  bool wasPreempted() const noexcept { return wasPreempted_; }
  /// Of the thread beside, a time a search [s].
  const std::vector<double>& refreshTimes() const noexcept { return refreshTimes_; }

 private:
  void workBeside();

  ServoParameters parameters_;
  SearchReach reach_;
  ListArrival arrival_;
  BenchClock clock_;
  SceneTracker tracker_;
  std::array<TrackedScene, 2> tracked_;
  std::size_t front_ = 0;
  bool isUnderWay_ = false;
  std::uint64_t ticks_ = 0, readyAt_ = 0;
  ServoTick tick_;
  std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
  double tickTime_ = 0.0;
  bool wasPreempted_ = false;
  std::vector<double> refreshTimes_;
};

}  // namespace nearfit::bench
