#include "core/haptics/step_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace nearfit {
namespace {

/// Distance of the rows that fill up a block: never the min.
constexpr double kNoRow = std::numeric_limits<double>::max();

bool isUsableNumber(double value) noexcept {
  return std::abs(value) <= StepRows::kLargest;
}

}  // namespace

StepRows::StepRows(std::size_t capacity) : blocks_((capacity + kLanes - 1) / kLanes), capacity_(capacity) {}

void StepRows::clear() noexcept {
  size_ = 0;
  largestNorm_ = 1.0;
}

bool StepRows::add(const StepVector& a, double d) noexcept {
  if (size_ == capacity_ || !isUsableNumber(d) || !std::all_of(a.begin(), a.end(), isUsableNumber))
    return false;
  Block& block = blocks_[size_ / kLanes];
  const std::size_t lane = size_ % kLanes;
  if (lane == 0) block.d.fill(kNoRow);
  double squared = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    block.a[k][lane] = a[k];
    squared += a[k] * a[k];
  }
  block.d[lane] = d;
  largestNorm_ = std::max(largestNorm_, std::sqrt(squared));
  ++size_;
  return true;
}

StepVector StepRows::row(std::size_t i) const noexcept {
  StepVector a;
  for (std::size_t k = 0; k < a.size(); ++k)
    a[k] = blocks_[i / kLanes].a[k][i % kLanes];
  return a;
}

double StepRows::distance(std::size_t i) const noexcept {
  return blocks_[i / kLanes].d[i % kLanes];
}

inline void StepRows::clearances(const Block& block, const StepVector& y,
                                 std::array<double, kLanes>& out) noexcept {
  for (std::size_t i = 0; i < kLanes; ++i)
    out[i] = block.a[0][i] * y[0] + block.a[1][i] * y[1] + block.a[2][i] * y[2] + block.a[3][i] * y[3] +
             block.a[4][i] * y[4] + block.a[5][i] * y[5] + block.d[i];
}

inline double StepRows::least(std::array<double, kLanes> values) noexcept {
// Unrolled so that the halves stay in registers.
#pragma GCC unroll 4
  for (std::size_t half = kLanes / 2; half > 0; half /= 2)
#pragma GCC unroll 8
    for (std::size_t i = 0; i < half; ++i)
      values[i] = values[i + half] < values[i] ? values[i + half] : values[i];
  return values[0];
}

StepRows::Least StepRows::leastClearance(const StepVector& y) const noexcept {
  Least result{kNoRow, 0};
  std::array<double, kLanes> values;
  std::size_t best = 0;
  const std::size_t blocks = (size_ + kLanes - 1) / kLanes;
  for (std::size_t b = 0; b < blocks; ++b) {
    clearances(blocks_[b], y, values);
    const double here = least(values);
    if (here < result.clearance) {
      result.clearance = here;
      best = b;
    }
  }
  if (blocks == 0) return result;
  clearances(blocks_[best], y, values);
  const auto found = std::find(values.begin(), values.end(), result.clearance);
  result.row = best * kLanes + static_cast<std::size_t>(found - values.begin());
  return result;
}

}  // namespace nearfit
