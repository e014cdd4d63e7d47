#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/servo/servo_scene.h"
#include "tests/bench/bench_clock.h"
#include "tests/bench/feel_report.h"

namespace nearfit::bench {

/// A path whose ticks are timed.
struct CostCase {
  std::string scene, run;
  std::shared_ptr<const ServoScene> servoScene;
  std::vector<RigidTransform> path;   ///< Of the hand, worldFromPart, at 1 kHz; begins where the part is.
  double cutoff = 0.0, margin = 0.0;  ///< [m]
};

struct CostOptions {
  std::size_t block = 100;  ///< Ticks in one mode before the other has its turn.
  std::size_t warmUp = 5;   ///< Of them, the first that are not timed.
  BenchClock clock = BenchClock::Wall;
};

/// What the proxy mode's ticks took, and those of the mode of springs at the part's poses. Of ticks that lost
/// the processor, `query`, `proxy` and what is made of them are left out.
struct CostRun {
  std::vector<double> tick, query, proxy, springs;      ///< [s]
  std::vector<double> proxyAt32, proxyAt256;            ///< Of ticks with about so many constraints [s].
  std::vector<double> constraints, contacts, subSteps;  ///< Of each timed tick.
  std::vector<double> lateBodies, shortened, refused;   ///< Of each timed tick.
  std::vector<RigidTransform> poses;                    ///< Of the proxy's part, tick by tick.
  std::vector<double> refresh;                          ///< Of the thread beside, each search [s].
};

/// Modes take turns of a block each; what the thread beside finds arrives as late as its search took.
CostRun runCost(const CostCase& scene, const CostOptions& options);

std::vector<FeelRow> costRows(const CostCase& scene, const CostRun& run);

}  // namespace nearfit::bench
