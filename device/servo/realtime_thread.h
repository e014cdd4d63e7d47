#pragma once

#include <string>

namespace nearfit {

/// What real-time service the system granted to a thread.
struct RealtimeGrant {
  int priority = 0;         ///< Of SCHED_FIFO; 0 when it was refused.
  int schedulingError = 0;  ///< errno of the refusal.
  bool isMemoryLocked = false;
  int lockError = 0;  ///< errno of the refusal.
  bool areProcessorsAwake = false;
  int awakeError = 0;  ///< errno of the refusal; ENOENT where the system has no such thing.

  /// For the user: what was granted; where something was refused, why and what to do about it. Nothing of
  /// memory or processors where nobody asked.
  std::string describe() const;
};

/// Asks for SCHED_FIFO and the finest timer for the calling thread, and touches its stack so that it does not
/// fault later. Allocates nothing; leaves the rest of `grant` alone.
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

/// Keeps idle processors from halting for as long as it lives (the kernel's PM QoS, as cyclictest does): a
/// thread that waits for a device's report then runs some microseconds after it, not tens. It costs power, so
/// it is for servos that a device paces.
class AwakeProcessors {
 public:
  /// @param device  Of the kernel: holds the request while it is open.
  explicit AwakeProcessors(RealtimeGrant& grant, const char* device = "/dev/cpu_dma_latency") noexcept;
  ~AwakeProcessors();
  AwakeProcessors(const AwakeProcessors&) = delete;
  AwakeProcessors& operator=(const AwakeProcessors&) = delete;

 private:
  int file_ = -1;
};

}  // namespace nearfit
