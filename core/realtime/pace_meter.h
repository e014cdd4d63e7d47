#pragma once

#include <cmath>
#include <cstdint>

namespace nearfit {

/// How regularly something comes: means over the last few dozen of the time between two, and of how far that
/// is off from its mean. Trivially copyable; real-time safe.
class PaceMeter {
 public:
  /// @param time  When it came, by a clock that never goes back [s]. One at the time of the last is the same.
  void see(double time) noexcept {
    const double passed = time - last_;
    if (count_ > 0 && !(passed > 0.0)) return;
    last_ = time;
    if (++count_ < 2) return;
    // The first few count alike.
    const double share = count_ - 1 < kMemory ? 1.0 / static_cast<double>(count_ - 1) : 1.0 / kMemory;
    interval_ += share * (passed - interval_);
    jitter_ += share * (std::abs(passed - interval_) - jitter_);
  }
  /// Mean time between two [s]; 0 before the second.
  double interval() const noexcept { return interval_; }
  /// Mean distance of that from its mean [s].
  double jitter() const noexcept { return jitter_; }

 private:
  static constexpr std::uint64_t kMemory = 64;
  double last_ = 0.0, interval_ = 0.0, jitter_ = 0.0;
  std::uint64_t count_ = 0;
};

}  // namespace nearfit
