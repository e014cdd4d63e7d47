#pragma once

#include <array>
#include <cstdint>

namespace nearfit {

/// Counts durations in logarithmic bins (1 % wide at least as fine) from 0.1 us to 100 s. Fixed size,
/// trivially copyable; recording is real-time safe. Percentiles are upper bounds of the bin, so never too
/// good.
class LatencyHistogram {
 public:
  /// @param times  How many alike.
  void record(double seconds, std::uint64_t times = 1) noexcept;
  void clear() noexcept { *this = LatencyHistogram(); }

  std::uint64_t count() const noexcept { return count_; }
  /// The duration that a fraction (0 to 1) of the records do not exceed [s]; 0 when there are none.
  double percentile(double fraction) const noexcept;
  double max() const noexcept { return max_; }
  double mean() const noexcept { return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_); }

 private:
  static constexpr std::size_t kBins = 2100;
  /// At 1 kHz 32 bits would be full after 49 days; 64 last longer than any machine. Twice the 8 KB is nothing
  /// to a copy every hundred ticks.
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double sum_ = 0.0, max_ = 0.0;
};

}  // namespace nearfit
