#pragma once

#include "core/haptics/dual_step_solver.h"

namespace nearfit::bench {

/// What the proxy's program is solved with elsewhere: rows one after another, each pushed until it holds,
/// sweep after sweep.
struct GaussSeidelStep {
  StepVector y{};
  double t = 0.0;
  unsigned sweeps = 0;
  bool isSettled = false;  ///< The last sweep moved nothing farther than the tolerance.
};

/// Projected Gauss-Seidel on the multipliers of the program. @param tolerance  [m]
GaussSeidelStep gaussSeidelStep(const StepRows& rows, const ClearanceCost& cost, const StepVector& y0,
                                double tolerance, unsigned mostSweeps);

}  // namespace nearfit::bench
