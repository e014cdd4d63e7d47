#pragma once

#include <signal.h>

namespace nearfit::cli {

/// Turns the first interrupt (SIGINT, SIGTERM) into a flag; the second one kills as usual. One at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  static bool isInterrupted() noexcept;

 private:
  struct sigaction oldInt_{}, oldTerm_{};
};

}  // namespace nearfit::cli
