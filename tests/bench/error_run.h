#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "tests/bench/bench_clock.h"
#include "tests/bench/error_measure.h"

namespace nearfit::bench {

struct ErrorRunOptions {
  std::vector<std::uint32_t> finenesses{1, 2, 4, 8, 16, 32, 64};
  std::size_t poses = 100;  ///< Of each pair, the same for each fineness and method.
  std::uint64_t seed = 1;   ///< Of the poses.
  std::size_t block = 20;   ///< Poses that a method answers before the next has its turn.
  BenchClock clock = BenchClock::Thread;
};

/// An error over the poses.
struct ErrorSummary {
  double rms = 0.0, max = 0.0;  ///< NaN where no pose has it.
};

/// Figures of one method at one fineness of a pair.
struct ErrorRow {
  std::string pair, method;
  std::uint32_t fineness = 0;
  double edge = 0.0;  ///< Longest of the tessellated solids [m].
  std::size_t sceneTriangles = 0, partTriangles = 0, poses = 0;
  std::size_t bytes = 0;        ///< As ErrorMethod::byteSize.
  double p50 = 0.0, p99 = 0.0;  ///< Of an answer [us].
  double aside = 0.0;           ///< What another thread does for it, a tick of the way on average [us].
  double truths = 0.0, minima = 0.0, missed = 0.0, spurious = 0.0, extra = 0.0;  ///< A pose, on average.
  ErrorSummary distance, position, direction, force, torque;                     ///< As AnswerErrors.
  /// Of an exact method: poses at which its minima are not those of the first exact one, to the last bit.
  std::size_t differing = 0;
};

/// Measures methods on one pair at each fineness. Methods take turns, so that a drift of the machine's speed
/// hits all alike. @param onRow  Called with each row as it is there; may be empty.
std::vector<ErrorRow> runErrors(const ErrorPair& pair, std::span<const ErrorMethodEntry> methods,
                                const ErrorRunOptions& options,
                                const std::function<void(const ErrorRow&)>& onRow = {});

/// The way to a pose: a hand's, at 0.2 m/s and 50 degrees/s in ticks of a millisecond. Ends with the pose.
/// @param seed  Of the direction.
std::vector<RigidTransform> wayTo(const RigidTransform& pose, std::size_t ticks, std::uint64_t seed);

/// Whether two answers have the same minima in the same order, to the last bit.
bool areSame(std::span<const Lmd> a, std::span<const Lmd> b);

std::string errorCsvHeader();
std::string errorCsvLine(const ErrorRow& row);
std::string errorTableHeader();
std::string errorTableLine(const ErrorRow& row);

}  // namespace nearfit::bench
