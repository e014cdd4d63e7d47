#include "core/realtime/latency_histogram.h"

#include <algorithm>
#include <cmath>

namespace nearfit {
namespace {

constexpr double kFirstBound = 1e-7;  ///< Upper bound of bin 0 [s].
constexpr double kBinRatio = 1.01;    ///< Ratio of the upper bounds of neighbouring bins.

/// Upper bound of a bin [s], padded so that rounding in log and pow never makes it too small.
double upperBound(std::size_t bin) noexcept {
  return kFirstBound * std::pow(kBinRatio, static_cast<double>(bin)) * (1.0 + 1e-9);
}

std::size_t binOf(double seconds, std::size_t binCount) noexcept {
  if (!(seconds > kFirstBound)) return 0;
  const double bin = std::ceil(std::log(seconds / kFirstBound) / std::log(kBinRatio) - 1e-9);
  return static_cast<std::size_t>(std::clamp(bin, 0.0, static_cast<double>(binCount - 1)));
}

}  // namespace

void LatencyHistogram::record(double seconds, std::uint64_t times) noexcept {
  if (std::isnan(seconds) || times == 0) return;
  seconds = std::max(seconds, 0.0);
  bins_[binOf(seconds, kBins)] += times;
  count_ += times;
  sum_ += static_cast<double>(times) * seconds;
  max_ = std::max(max_, seconds);
}

LatencyHistogram LatencyHistogram::since(const LatencyHistogram& earlier) const {
  LatencyHistogram later;
  later.count_ = count_ - earlier.count_;
  later.sum_ = sum_ - earlier.sum_;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    later.bins_[bin] = bins_[bin] - earlier.bins_[bin];
    if (later.bins_[bin] > 0) later.max_ = bin + 1 < kBins ? std::min(upperBound(bin), max_) : max_;
  }
  return later;
}

double LatencyHistogram::percentile(double fraction) const noexcept {
  if (count_ == 0) return 0.0;
  const double rank = std::max(1.0, std::ceil(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(count_)));
  double seen = 0.0;
  // The last bin also holds all longer durations; only the max bounds it.
  for (std::size_t bin = 0; bin + 1 < kBins; ++bin) {
    seen += static_cast<double>(bins_[bin]);
    if (seen >= rank) return std::min(upperBound(bin), max_);
  }
  return max_;
}

}  // namespace nearfit
