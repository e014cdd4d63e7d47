#include "tests/exact/exact_step.h"

#include <cmath>

#include <CGAL/Gmpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

namespace nearfit::test {
namespace {

using ExactFloat = CGAL::Gmpzf;
using Program = CGAL::Quadratic_program<ExactFloat>;

constexpr int kClearance = 6;

}  // namespace

ExactStep exactStep(const StepRows& rows, const ClearanceCost& cost, const StepVector& y0) {
  Program program(CGAL::LARGER, false, ExactFloat(0), false, ExactFloat(0));
  for (int k = 0; k < kClearance; ++k) {
    program.set_d(k, k, ExactFloat(1));
    program.set_c(k, -ExactFloat(y0[static_cast<std::size_t>(k)]));
  }
  program.set_d(kClearance, kClearance, ExactFloat(cost.weight));
  program.set_c(kClearance, -(ExactFloat(cost.weight) * ExactFloat(cost.margin)));
  if (std::isfinite(cost.floor)) program.set_l(kClearance, true, ExactFloat(cost.floor));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int row = static_cast<int>(i);
    const StepVector a = rows.row(i);
    for (int k = 0; k < kClearance; ++k)
      program.set_a(k, row, ExactFloat(a[static_cast<std::size_t>(k)]));
    program.set_a(kClearance, row, ExactFloat(-1));
    program.set_b(row, -ExactFloat(rows.distance(i)));
  }
  const auto solution = CGAL::solve_quadratic_program(program, ExactFloat());
  ExactStep out;
  out.isSolved = solution.is_optimal();
  auto value = solution.variable_values_begin();
  for (std::size_t k = 0; k < y0.size(); ++k, ++value)
    out.y[k] = CGAL::to_double(*value);
  out.t = CGAL::to_double(*value);
  return out;
}

}  // namespace nearfit::test
