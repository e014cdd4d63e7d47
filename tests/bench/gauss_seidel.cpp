#include "tests/bench/gauss_seidel.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace nearfit::bench {
namespace {

/// A row of the program in its seven scaled unknowns.
struct Row {
  ProgramVector n{};
  double b = 0.0, squared = 0.0, multiplier = 0.0;
};

std::vector<Row> rowsOf(const StepRows& rows, const ClearanceCost& cost, double inverseRoot) {
  std::vector<Row> out(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const StepVector a = rows.row(i);
    std::copy(a.begin(), a.end(), out[i].n.begin());
    out[i].n[6] = -inverseRoot;
    out[i].b = cost.margin - rows.distance(i);
  }
  if (std::isfinite(cost.floor)) {
    Row floor;
    floor.n[6] = inverseRoot;
    floor.b = cost.floor - cost.margin;
    out.push_back(floor);
  }
  for (Row& row : out)
    row.squared = dot(row.n, row.n);
  return out;
}

}  // namespace

GaussSeidelStep gaussSeidelStep(const StepRows& rows, const ClearanceCost& cost, const StepVector& y0,
                                double tolerance, unsigned mostSweeps) {
  const double inverseRoot = 1.0 / std::sqrt(cost.weight);
  std::vector<Row> all = rowsOf(rows, cost, inverseRoot);
  ProgramVector z{};
  std::copy(y0.begin(), y0.end(), z.begin());
  GaussSeidelStep out;
  while (out.sweeps < mostSweeps && !out.isSettled) {
    ++out.sweeps;
    double moved = 0.0;
    for (Row& row : all) {
      const double wanted = row.multiplier + (row.b - dot(row.n, z)) / row.squared;
      const double change = std::max(0.0, wanted) - row.multiplier;
      row.multiplier += change;
      z = along(z, change, row.n);
      moved = std::max(moved, std::abs(change) * std::sqrt(row.squared));
    }
    out.isSettled = moved <= tolerance;
  }
  std::copy(z.begin(), z.begin() + 6, out.y.begin());
  out.t = cost.margin + inverseRoot * z[6];
  return out;
}

}  // namespace nearfit::bench
