#include "tests/exact/exact_step.h"

#include <cmath>

#include <CGAL/Gmpzf.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>

namespace nearfit::test {
namespace {

using Number = CGAL::Gmpzf;
using Program = CGAL::Quadratic_program<Number>;

constexpr int kClearance = 6;

}  // namespace

ExactStep exactStep(const StepRows& rows, const ClearanceCost& cost, const StepVector& y0) {
  Program program(CGAL::LARGER, false, Number(0), false, Number(0));
  for (int k = 0; k < kClearance; ++k) {
    program.set_d(k, k, Number(1));
    program.set_c(k, -Number(y0[static_cast<std::size_t>(k)]));
  }
  program.set_d(kClearance, kClearance, Number(cost.weight));
  program.set_c(kClearance, -(Number(cost.weight) * Number(cost.margin)));
  if (std::isfinite(cost.floor)) program.set_l(kClearance, true, Number(cost.floor));
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const int row = static_cast<int>(i);
    const StepVector a = rows.row(i);
    for (int k = 0; k < kClearance; ++k)
      program.set_a(k, row, Number(a[static_cast<std::size_t>(k)]));
    program.set_a(kClearance, row, Number(-1));
    program.set_b(row, -Number(rows.distance(i)));
  }
  const auto solution = CGAL::solve_quadratic_program(program, Number());
  ExactStep out;
  out.isSolved = solution.is_optimal();
  auto value = solution.variable_values_begin();
  for (std::size_t k = 0; k < y0.size(); ++k, ++value)
    out.y[k] = CGAL::to_double(*value);
  out.t = CGAL::to_double(*value);
  return out;
}

}  // namespace nearfit::test
