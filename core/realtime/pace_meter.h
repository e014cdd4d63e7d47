#pragma once

#include <cmath>
#include <cstdint>

namespace nearfit {

/// Measures how regularly events arrive: mean interval and mean deviation from it, over the last few dozen
/// events. Trivially copyable; real-time safe.
class PaceMeter {
 public:
  /// Records an event.
  /// @param time  Arrival time on a monotonic clock [s]. A time not after the last one counts as
  ///              the same event.
  void see(double time) noexcept {
    const double passed = time - last_;
    if (count_ > 0 && !(passed > 0.0)) return;
    last_ = time;
    if (++count_ < 2) return;
    // A plain mean until the memory is full.
    const double share = count_ - 1 < kMemory ? 1.0 / static_cast<double>(count_ - 1) : 1.0 / kMemory;
    interval_ += share * (passed - interval_);
    jitter_ += share * (std::abs(passed - interval_) - jitter_);
  }
  /// Mean time between events [s]; 0 before the second event.
  double interval() const noexcept { return interval_; }
  /// Mean absolute deviation of the intervals from their mean [s].
  double jitter() const noexcept { return jitter_; }

 private:
  static constexpr std::uint64_t kMemory = 64;
  double last_ = 0.0, interval_ = 0.0, jitter_ = 0.0;
  std::uint64_t count_ = 0;
};

}  // namespace nearfit
