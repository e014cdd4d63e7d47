#include "tests/bench/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace nearfit::bench {

SampleSummary::SampleSummary(std::vector<double> samples) : sorted_(std::move(samples)) {
  std::sort(sorted_.begin(), sorted_.end());
  mean_ = std::accumulate(sorted_.begin(), sorted_.end(), 0.0) / static_cast<double>(sorted_.size());
}

double SampleSummary::percentile(double fraction) const {
  if (sorted_.empty()) return std::numeric_limits<double>::quiet_NaN();
  // Without the allowance 0.999 * 1000 would be the 1000th.
  const double rank = std::ceil(fraction * static_cast<double>(sorted_.size()) - 1e-9);
  const auto index = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
  return sorted_[std::min(index, sorted_.size() - 1)];
}

std::vector<double> bestOfRounds(std::span<const double> samples, std::size_t poses) {
  std::vector<double> best(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(poses));
  for (std::size_t i = poses; i < samples.size(); ++i)
    best[i % poses] = std::min(best[i % poses], samples[i]);
  return best;
}

}  // namespace nearfit::bench
