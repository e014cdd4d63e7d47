#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tests/bench/bench_clock.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench {

struct RunOptions {
  BenchClock clock = BenchClock::Wall;
  std::size_t block = 100;       ///< Poses that a method answers before the next has its turn.
  std::size_t warmUp = 5;        ///< Poses before each block that are answered but not timed.
  std::size_t rounds = 1;        ///< Times the whole path is walked.
  std::size_t pairsStride = 40;  ///< Slow methods (isSlow) answer each so-many-th pose only.
  /// Time from one query to the next [s], as a servo has it, so that a method's other threads have theirs; 0:
  /// back to back.
  double period = 0.0;
  std::optional<int> cpu;  ///< The measuring thread stays on this one.
};

/// What was measured of one method.
struct MethodRun {
  const MethodEntry* method;
  std::vector<std::size_t> poses;  ///< Indices of the poses answered in a round.
  std::vector<double> times;       ///< [s]; round after round, each as `poses`.
  std::vector<Answer> answers;     ///< Of the first round, as `poses`.
  std::string remark;              ///< The method's own, see QueryMethod.
  long preemptions = 0;  ///< Times that the thread lost its core to another during the timed blocks.
};

/// Keeps the calling thread, and those that it makes, on one processor. Throws UsageError when it cannot be
/// had.
void pinTo(int cpu);

/// Measures methods on a path in turns of a block each, so that a drift of the machine's speed hits all
/// alike; each round begins with the next method. Throws Error when the thread cannot be pinned.
std::vector<MethodRun> runInterleaved(std::span<const MethodEntry> methods, const PreparedScene& scene,
                                      std::span<const RigidTransform> path, const RunOptions& options);

}  // namespace nearfit::bench
