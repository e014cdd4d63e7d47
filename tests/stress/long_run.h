#pragma once

#include <cstdint>

#include "tests/stress/stress_mode.h"

namespace nearfit::stress {

struct LongRunResult {
  std::uint64_t ticks = 0;
  std::uint64_t cycles = 0;       ///< Of the hand's path, which is the same each time.
  double freeDrift = 0.0;         ///< Part off the hand where it is free, at worst [m]; must be zero.
  double contactDrift = 0.0;      ///< Of where the part rests in contact, against the first cycle [m].
  double forceDrift = 0.0;        ///< Of the force there [N].
  double lateDrift = 0.0;         ///< As contactDrift, in the last tenth of the run.
  std::int64_t memoryGrowth = 0;  ///< Resident, since the second cycle [bytes].
  double energyDrift = 0.0;       ///< Of the energy given to the hand in a cycle, last against second [J].
};

/// Simulated hours at 1 kHz: a cube over a floor that is set down, pressed, slid, turned, lifted and held, in
/// cycles of ten seconds. With springs it is pressed less far, so that it stays above the floor.
/// @param seconds  Simulated.
LongRunResult runLong(double seconds, StressMode mode = StressMode::Proxy);

/// What a drift may be: the proxy comes to rest to a thousandth of the margin.
constexpr double kLongMargin = 1e-4, kMaxDrift = 2e-3 * kLongMargin;
/// What the force may differ by in the same place a cycle later: springs know nothing of the past but their damping's
/// filter, which is at rest there, and a share that rises (kShareRiseTime), which is 1 for them [N].
constexpr double kMaxForceDrift = 1e-3;
/// Allocators keep some.
constexpr std::int64_t kMaxGrowth = 2 << 20;  // [bytes]

}  // namespace nearfit::stress
