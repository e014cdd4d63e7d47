#pragma once

#include <cstdint>

namespace nearfit {

/// On CLOCK_MONOTONIC [ns]: what deadlines of the servo and arrivals of reports are counted in.
using Nanoseconds = std::int64_t;
constexpr Nanoseconds kNanosecondsPerSecond = 1'000'000'000;

Nanoseconds monotonicNow() noexcept;

inline double toSeconds(Nanoseconds t) noexcept {
  return static_cast<double>(t) * 1e-9;
}

/// Sleeps till a little before the deadline, and spins for the rest (kSpin at most): the scheduler wakes a
/// thread some 30 us late.
void waitUntil(Nanoseconds deadline) noexcept;

/// Longer would burn a core; real-time threads that never sleep are stopped by the kernel.
constexpr Nanoseconds kSpin = 50'000;

/// A bell between two threads: one rings, one sleeps until it has rung since it last woke, or until a
/// deadline. Rings that nobody waited for count as one. Neither side locks or allocates.
class WakeSignal {
 public:
  /// One system call, and that only when somebody sleeps.
  void ring() noexcept;
  /// True when it has rung since the last call. One waiting thread.
  bool wait(Nanoseconds deadline) noexcept;

 private:
  std::uint32_t seen_ = 0;              ///< The waiter's.
  alignas(64) std::uint32_t rung_ = 0;  ///< Accessed atomically; a futex.
  std::uint32_t sleepers_ = 0;          ///< Accessed atomically.
};

}  // namespace nearfit
