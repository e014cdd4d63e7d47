#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/servo/servo_tick.h"
#include "tests/bench/interleaved_run.h"

namespace nearfit::bench {

/// A scene whose ticks are measured.
struct TickScene {
  std::string name;
  std::shared_ptr<const ServoScene> scene;
  HapticMode mode = HapticMode::Springs;
  /// Takes from what another thread has found, each time; none by default.
  std::function<void(TrackedScene&)> alter = {};
};

/// What was measured of one.
struct TickRun {
  std::string name;
  std::size_t parts = 0;               ///< That stay where they are.
  std::vector<double> tickTimes;       ///< [s]; of each round in turn, without ticks to warm up.
  std::vector<double> refreshTimes;    ///< [s]; the other thread's.
  std::vector<std::uint64_t> digests;  ///< Of what each tick gave, those to warm up included.
  std::size_t lateTicks = 0, truncatedTicks = 0;
  std::size_t mostNear = 0;  ///< Parts that a tick looked at.
  std::size_t ticksWithMinima = 0;
};

/// A number that is another one, but for chance, when a bit of the wrench, of the distance or of a stored
/// minimum is another one. Part ids count, times do not.
std::uint64_t digestOf(const ServoSnapshot& snapshot) noexcept;

/// Index of the first tick that gave something else; a tick that only one has counts as well.
std::optional<std::size_t> firstDifference(const TickRun& a, const TickRun& b);

/// Runs the servo's ticks along a path in each scene: what another thread would have found is there before
/// each tick. Scenes take turns of a block each; the part moves on without a jump from block to block, and
/// the first ticks of each are not timed. `options.period` does not count. Throws Error when the thread
/// cannot be pinned.
std::vector<TickRun> runTicks(std::span<const TickScene> scenes, std::span<const RigidTransform> path,
                              double cutoff, const RunOptions& options);

}  // namespace nearfit::bench
