#pragma once

#include "core/haptics/dual_step_solver.h"

namespace nearfit::test {

/// The program's optimum, solved in exact arithmetic by CGAL and rounded once.
struct ExactStep {
  StepVector y{};
  double t = 0.0;
  bool isSolved = false;
};

/// @param y0  And all other numbers are taken as the rationals that they are.
ExactStep exactStep(const StepRows& rows, const ClearanceCost& cost, const StepVector& y0);

}  // namespace nearfit::test
