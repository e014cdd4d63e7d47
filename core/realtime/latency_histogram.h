#pragma once

#include <array>
#include <cstdint>

namespace nearfit {

/// Counts durations in logarithmic bins, 1 % wide, from 0.1 us to 100 s. Fixed size, trivially copyable,
/// real-time safe. A percentile is the upper bound of its bin, so it never flatters.
class LatencyHistogram {
 public:
  /// Records a duration [s] `times` times. NaN is ignored; a negative duration counts as 0.
  void record(double seconds, std::uint64_t times = 1) noexcept;
  void clear() noexcept { *this = LatencyHistogram(); }

  /// Durations recorded since `earlier`, a copy of this histogram from before; not real-time safe. The longest
  /// duration is exact if it is the longest of all, else the upper bound of its bin.
  LatencyHistogram since(const LatencyHistogram& earlier) const;

  std::uint64_t count() const noexcept { return count_; }
  /// Duration that the given fraction (0 to 1) of the records do not exceed [s]; 0 without records.
  double percentile(double fraction) const noexcept;
  /// Longest duration recorded [s]; 0 without records.
  double max() const noexcept { return max_; }
  /// Mean duration [s]; 0 without records.
  double mean() const noexcept { return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_); }

 private:
  static constexpr std::size_t kBins = 2100;
  /// At 1 kHz, 32 bits would overflow after 49 days; 64 bits never do. The extra 8 KB do not matter in a copy
  /// every hundred ticks.
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double sum_ = 0.0, max_ = 0.0;
};

}  // namespace nearfit
