#pragma once

#include <ctime>

namespace nearfit::bench {

enum class BenchClock {
  Wall,    ///< What a user waits for.
  Thread,  ///< Time on a processor alone, for a machine that others use; reading it costs some 0.2 us.
  Process  ///< The same of all threads, for work that is shared among them.
};

/// Seconds from some beginning.
inline double secondsBy(BenchClock clock) noexcept {
  timespec now{};
  clock_gettime(clock == BenchClock::Wall     ? CLOCK_MONOTONIC
                : clock == BenchClock::Thread ? CLOCK_THREAD_CPUTIME_ID
                                              : CLOCK_PROCESS_CPUTIME_ID,
                &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace nearfit::bench
