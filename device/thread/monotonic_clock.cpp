#include "device/thread/monotonic_clock.h"

#include <atomic>
#include <cerrno>

#include <linux/futex.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

namespace nearfit {
namespace {

timespec timespecOf(Nanoseconds t) noexcept {
  return {t / kNanosecondsPerSecond, t % kNanosecondsPerSecond};
}

}  // namespace

Nanoseconds monotonicNow() noexcept {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * kNanosecondsPerSecond + t.tv_nsec;
}

void waitUntil(Nanoseconds deadline) noexcept {
  const timespec nearly = timespecOf(deadline - kSpin);
  if (deadline - kSpin > monotonicNow()) {
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &nearly, nullptr) == EINTR) {
    }
  }
  while (monotonicNow() < deadline) {
  }
}

void WakeSignal::ring() noexcept {
  std::atomic_ref(rung_).fetch_add(1, std::memory_order_seq_cst);
  if (std::atomic_ref(sleepers_).load(std::memory_order_seq_cst) != 0)
    ::syscall(SYS_futex, &rung_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

bool WakeSignal::wait(Nanoseconds deadline) noexcept {
  const timespec until = timespecOf(deadline);
  std::atomic_ref(sleepers_).store(1, std::memory_order_seq_cst);
  std::uint32_t now = std::atomic_ref(rung_).load(std::memory_order_seq_cst);
  while (now == seen_ && monotonicNow() < deadline) {
    // An absolute time on CLOCK_MONOTONIC, which plain FUTEX_WAIT does not take.
    ::syscall(SYS_futex, &rung_, FUTEX_WAIT_BITSET_PRIVATE, seen_, &until, nullptr, FUTEX_BITSET_MATCH_ANY);
    now = std::atomic_ref(rung_).load(std::memory_order_acquire);
  }
  std::atomic_ref(sleepers_).store(0, std::memory_order_relaxed);
  const bool hasRung = now != seen_;
  seen_ = now;
  return hasRung;
}

}  // namespace nearfit
