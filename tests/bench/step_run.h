#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/bench_clock.h"
#include "tests/support/step_problems.h"

namespace nearfit::bench {

struct StepRunOptions {
  std::vector<std::size_t> rows{8, 32, 64, 128, 256};
  std::size_t problems = 2000;  ///< Of each kind and number of rows.
  std::size_t rounds = 3;
  double reachMargins = 1.5;  ///< Reach of the trust region, in margins.
  std::uint64_t seed = 1;
  /// Gauss and Seidel's method and CGAL's exact solver answer each so-many-th problem only.
  std::size_t gaussSeidelStride = 20, exactStride = 100;
  BenchClock clock = BenchClock::Wall;
};

/// Figures of one method on one kind of problems; times in microseconds.
struct StepRunRow {
  std::string kind, method;
  std::size_t rows = 0, solved = 0;
  double p50 = 0.0, p99 = 0.0, p999 = 0.0, max = 0.0;
  double solves = 0.0, changes = 0.0;  ///< Mean per problem: solves, and changes of the active set or sweeps.
  double settled = 1.0;                ///< Share of the problems that the method says are solved.
  /// Largest difference from the reference's step, as a fraction of the lengths in play; the reference is
  /// StepProgram's.
  double differs = 0.0;
};

/// Times the program of the proxy's step on generated contacts. Each problem is written into the same rows
/// just before it is solved, as the servo does.
std::vector<StepRunRow> runSteps(const StepRunOptions& options);

std::string stepRunTable(const std::vector<StepRunRow>& rows);
std::string stepRunCsv(const std::vector<StepRunRow>& rows);

}  // namespace nearfit::bench
