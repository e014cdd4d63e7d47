#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tests/stress/stress_mode.h"
#include "tests/stress/stress_scene.h"
#include "tests/stress/tick_checks.h"

namespace nearfit::stress {

struct HandRunOptions {
  std::uint64_t ticks = 10000;
  std::uint64_t seed = 1;
  std::uint64_t certifyEvery = 1;  ///< Poses that exact predicates look at: each so many-th; 0: none.
  /// With springs the part may go through others: no pose is certified then.
  StressMode mode = StressMode::Proxy;
};

struct HandRunResult {
  std::uint64_t ticks = 0;
  std::uint64_t certified = 0;  ///< Poses that were looked at; equal ones that follow each other once.
  std::uint64_t meetings = 0;   ///< Of them, those at which the part meets the scene.
  TickExtremes extremes;
  double energyGain = 0.0;   ///< EnergyLedger's [J].
  double ledgerError = 0.0;  ///< Largest difference between its account and the servo's, relative.
  /// The first thing that was wrong, with its tick and the stretch's kind.
  std::optional<std::string> failure;
};

/// An adversarial hand on a scene, by whole ticks of the servo in virtual time. Settings change in episodes:
/// friction, weight, inertia, coupling, margin, the servo's period and how late lists come, whether the hand
/// is led along its path or held by a grip with mass; with springs also their stiffness and damping. Ends at the first failure.
HandRunResult runHand(const StressScene& scene, const HandRunOptions& options);

}  // namespace nearfit::stress
