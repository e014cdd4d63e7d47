#include "core/haptics/step_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/proximity/query/double_lanes.h"

namespace nearfit {
namespace {

/// Distance of the rows that fill up a block: never the min.
constexpr double kNoRow = std::numeric_limits<double>::max();

bool isUsableNumber(double value) noexcept {
  return std::abs(value) <= StepRows::kLargest;
}

}  // namespace

StepRows::StepRows(std::size_t capacity, SimdLevel level)
    : blocks_((capacity + kLanes - 1) / kLanes), capacity_(capacity), leastKernel_(leastKernel(level)) {}

void StepRows::clear() noexcept {
  size_ = 0;
  largestSquare_ = 1.0;
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
  largestSquare_ = std::max(largestSquare_, squared);
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

/// The kernel for each instruction set.
struct StepRows::Kernels {
  NEARFIT_INLINE static Least least(const Block* blocks, std::size_t count, const StepVector& y) {
    using simd::Doubles8;
    using simd::Mask8;
    // The least of each lane, and its block.
    Doubles8 lowest = Doubles8{} + kNoRow;
    Mask8 at{};
    for (std::size_t b = 0; b < count; ++b) {
      const Block& block = blocks[b];
      Doubles8 clearance = simd::lanesOf<Doubles8>(block.a[0]).value * y[0];
      for (std::size_t k = 1; k < block.a.size(); ++k)
        clearance += simd::lanesOf<Doubles8>(block.a[k]).value * y[k];
      clearance += simd::lanesOf<Doubles8>(block.d).value;
      const Mask8 isLess = clearance < lowest;
      lowest = isLess ? clearance : lowest;
      at = isLess ? Mask8{} + static_cast<std::int64_t>(b) : at;
    }
    double values[kLanes];
    std::int64_t found[kLanes];
    __builtin_memcpy(values, &lowest, sizeof values);
    __builtin_memcpy(found, &at, sizeof found);
    Least out{kNoRow, 0};
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t row = static_cast<std::size_t>(found[lane]) * kLanes + lane;
      if (values[lane] < out.clearance || (values[lane] == out.clearance && row < out.row))
        out = {values[lane], row};
    }
    return out;
  }

  static Least portable(const Block* blocks, std::size_t count, const StepVector& y) noexcept {
    return least(blocks, count, y);
  }
#if defined(__x86_64__)
  NEARFIT_AVX2 static Least avx2(const Block* blocks, std::size_t count, const StepVector& y) noexcept {
    return least(blocks, count, y);
  }
  NEARFIT_AVX512 static Least avx512(const Block* blocks, std::size_t count, const StepVector& y) noexcept {
    return least(blocks, count, y);
  }
#endif
};

StepRows::LeastKernel StepRows::leastKernel(SimdLevel level) noexcept {
#if defined(__x86_64__)
  if (level == SimdLevel::Avx512) return Kernels::avx512;
  if (level == SimdLevel::Avx2) return Kernels::avx2;
#endif
  static_cast<void>(level);
  return Kernels::portable;
}

StepRows::Least StepRows::leastClearance(const StepVector& y) const noexcept {
  return leastKernel_(blocks_.data(), (size_ + kLanes - 1) / kLanes, y);
}

}  // namespace nearfit
