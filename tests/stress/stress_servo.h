#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <random>

#include "core/servo/scene_tracker.h"
#include "core/servo/servo_tick.h"

namespace nearfit::stress {

/// How many ticks it takes from the start of a search beside the servo until a tick has what it found.
enum class Arrival {
  AtOnce,   ///< The next tick has it.
  Usual,    ///< One to four ticks.
  Stalled,  ///< Now and then hundreds: the other thread does not get its processor.
};

/// The servo's tick with the thread beside it, in virtual time: what the thread finds arrives after so many
/// ticks as a seeded number says, so that runs are the same again on every machine.
class StressServo {
 public:
  StressServo(std::shared_ptr<const ServoScene> scene, const ServoParameters& parameters, std::uint64_t seed);

  /// One tick, and then what is done beside. `period` [s].
  const ServoSnapshot& tick(const HandleInput& input, double period);

  /// For the ticks to come.
  ServoParameters& parameters() noexcept { return parameters_; }
  void setArrival(Arrival arrival) noexcept { arrival_ = arrival; }
  /// As a reset of the servo's tick.
  void reset() noexcept { tick_.reset(); }

  const ServoSnapshot& snapshot() const noexcept { return *snapshot_; }

 private:
  void workBeside();
  std::uint64_t delay();

  ServoParameters parameters_;
  SceneTracker tracker_;
  std::array<TrackedScene, 2> tracked_;
  std::size_t front_ = 0;
  bool isUnderWay_ = false;
  std::uint64_t ticks_ = 0, readyAt_ = 0;
  Arrival arrival_ = Arrival::AtOnce;
  std::mt19937_64 random_;
  ServoTick tick_;
  std::unique_ptr<ServoSnapshot> snapshot_ = std::make_unique<ServoSnapshot>();
};

}  // namespace nearfit::stress
