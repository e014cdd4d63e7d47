#pragma once

#include <string>

namespace nearfit {

/// What real-time service the system granted to a thread.
struct RealtimeGrant {
  int priority = 0;         ///< Of SCHED_FIFO; 0 when it was refused.
  int schedulingError = 0;  ///< errno of the refusal.
  bool isMemoryLocked = false;
  int lockError = 0;  ///< errno of the refusal.

  /// For the user: what was granted; where something was refused, why and what to do about it. Nothing of
  /// memory where nobody asked to lock it.
  std::string describe() const;
};

/// Asks for SCHED_FIFO and the finest timer for the calling thread, and touches its stack so that it does not
/// fault later. Allocates nothing. `isMemoryLocked` and `lockError` are left alone.
void requestRealtimeScheduling(RealtimeGrant& grant) noexcept;

/// Keeps all memory of the process, present and future, from being paged out for as long as it lives, where
/// that is allowed without a limit. Under a limit it locks nothing: later allocations of the whole program
/// would then fail.
class MemoryLock {
 public:
  explicit MemoryLock(RealtimeGrant& grant) noexcept;
  ~MemoryLock();
  MemoryLock(const MemoryLock&) = delete;
  MemoryLock& operator=(const MemoryLock&) = delete;

 private:
  bool isLocked_ = false;
};

}  // namespace nearfit
