#pragma once

#include <signal.h>

namespace nearfit::cli {

/// Turns the first interrupt (SIGINT, SIGTERM) into a flag; a second one kills as usual. Only
/// one guard at a time.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// True if an interrupt came since the last guard was made.
  static bool isInterrupted() noexcept;

 private:
  struct sigaction oldInt_{}, oldTerm_{};
};

}  // namespace nearfit::cli
