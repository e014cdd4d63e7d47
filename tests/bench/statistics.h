#pragma once

#include <span>
#include <vector>

namespace nearfit::bench {

/// Nearest-rank percentiles of samples: of n samples in order, percentile p is the ceil(p n)-th.
class SampleSummary {
 public:
  explicit SampleSummary(std::vector<double> samples);

  /// @param fraction  In (0, 1]. NaN when there are no samples.
  double percentile(double fraction) const;
  double max() const { return percentile(1.0); }
  double mean() const { return mean_; }

 private:
  std::vector<double> sorted_;
  double mean_ = 0.0;
};

/// Keeps for each pose the least of its samples. @param samples  Whole rounds, each of `poses` samples.
std::vector<double> bestOfRounds(std::span<const double> samples, std::size_t poses);

}  // namespace nearfit::bench
