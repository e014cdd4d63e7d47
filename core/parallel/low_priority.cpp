#include "core/parallel/low_priority.h"

#include <sys/resource.h>
#include <unistd.h>

namespace nearfit {

void lowerThreadPriority(ThreadPriority priority) noexcept {
  // Values of nice: at 10, a thread at 0 has nine tenths of a processor that both want.
  const int nice = priority == ThreadPriority::Background ? 10 : 19;
  // Linux keeps the priority by thread, and takes a thread's number for a process'.
  const auto thread = static_cast<id_t>(gettid());
  if (getpriority(PRIO_PROCESS, thread) < nice) (void)setpriority(PRIO_PROCESS, thread, nice);
}

}  // namespace nearfit
