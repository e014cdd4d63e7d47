#pragma once

#include <string>

namespace nearfit {

/// Real-time service that the system granted to a thread.
struct RealtimeGrant {
  int priority = 0;         ///< SCHED_FIFO priority; 0 if refused.
  int schedulingError = 0;  ///< errno if refused.
  bool isMemoryLocked = false;
  int lockError = 0;  ///< errno if refused.
  bool areProcessorsAwake = false;
  int awakeError = 0;  ///< errno if refused; ENOENT if the system lacks the device.

  /// Tells the user what was granted and, for each refusal, why and what to do about it. Omits memory and
  /// processors if they were not requested.
  std::string describe() const;
};

/// Requests SCHED_FIFO and the finest timer for the calling thread, and touches its stack so that it does not
/// fault later. Allocates nothing; sets only the scheduling fields of `grant`.
void requestRealtimeScheduling(RealtimeGrant& grant) noexcept;

/// Keeps all memory of the process, present and future, from being paged out while it lives, if that
/// is allowed without a limit. Under a limit it locks nothing: later allocations of the whole
/// program would then fail.
class MemoryLock {
 public:
  explicit MemoryLock(RealtimeGrant& grant) noexcept;
  ~MemoryLock();
  MemoryLock(const MemoryLock&) = delete;
  MemoryLock& operator=(const MemoryLock&) = delete;

 private:
  bool isLocked_ = false;
};

/// Keeps idle processors from halting while it lives (the kernel's PM QoS, as in cyclictest): a thread
/// that waits for a report then runs microseconds after it, not tens. It costs power, so it is for servos
/// that a device paces.
class AwakeProcessors {
 public:
  /// @param device  Kernel device that holds the request while open.
  explicit AwakeProcessors(RealtimeGrant& grant, const char* device = "/dev/cpu_dma_latency") noexcept;
  ~AwakeProcessors();
  AwakeProcessors(const AwakeProcessors&) = delete;
  AwakeProcessors& operator=(const AwakeProcessors&) = delete;

 private:
  int file_ = -1;
};

}  // namespace nearfit
