#pragma once

#include <cstdint>

namespace nearfit {

/// Time on CLOCK_MONOTONIC [ns], for deadlines of the servo and arrivals of reports.
using Nanoseconds = std::int64_t;
constexpr Nanoseconds kNanosecondsPerSecond = 1'000'000'000;

Nanoseconds monotonicNow() noexcept;

inline double toSeconds(Nanoseconds t) noexcept {
  return static_cast<double>(t) * 1e-9;
}

/// Sleeps until shortly before the deadline, then spins (kSpin at most): the scheduler wakes a
/// thread some 30 us late.
void waitUntil(Nanoseconds deadline) noexcept;

/// Spinning longer would waste a core, and the kernel stops real-time threads that never sleep.
constexpr Nanoseconds kSpin = 50'000;

/// A bell between two threads: one rings, the other sleeps until it rings or until a deadline. Rings that
/// nobody waits for count as one. Neither side locks or allocates.
class WakeSignal {
 public:
  /// Wakes the waiter; makes one system call, and only if it sleeps.
  void ring() noexcept;
  /// Sleeps until it rings or until `deadline`. Returns true if it rang since the last call. One
  /// waiting thread only.
  bool wait(Nanoseconds deadline) noexcept;

 private:
  std::uint32_t seen_ = 0;              ///< Used by the waiter.
  alignas(64) std::uint32_t rung_ = 0;  ///< Accessed atomically; a futex.
  std::uint32_t sleepers_ = 0;          ///< Accessed atomically.
};

}  // namespace nearfit
