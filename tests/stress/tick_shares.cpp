#include "tests/stress/tick_shares.h"

#include <algorithm>
#include <cmath>

namespace nearfit::stress {
namespace {

/// Ticks of a scene by what a scene whose tick costs one has.
std::uint64_t ticksOf(double cost, double ofOne) {
  return std::max(kMinTicks, static_cast<std::uint64_t>(ofOne / std::sqrt(cost)));
}

std::uint64_t sumOf(std::span<const double> costs, double ofOne) {
  std::uint64_t sum = 0;
  for (const double cost : costs)
    sum += ticksOf(cost, ofOne);
  return sum;
}

}  // namespace

std::vector<std::uint64_t> shareTicks(std::span<const double> costs, std::uint64_t total) {
  const std::size_t count = costs.size();
  std::vector<std::uint64_t> shares(count);
  if (count == 0) return shares;
  if (total / count < kMinTicks) {
    for (std::size_t i = 0; i < count; ++i)
      shares[i] = total / count + (i < total % count ? 1 : 0);
    return shares;
  }
  // The most that does not come to more than all ticks.
  const auto cheapest = static_cast<std::size_t>(std::ranges::min_element(costs) - costs.begin());
  double low = 0.0, high = std::sqrt(costs[cheapest]) * static_cast<double>(total);
  constexpr int kHalvings = 100;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (sumOf(costs, middle) <= total ? low : high) = middle;
  }
  for (std::size_t i = 0; i < count; ++i)
    shares[i] = ticksOf(costs[i], low);
  shares[cheapest] += total - sumOf(costs, low);
  return shares;
}

}  // namespace nearfit::stress
