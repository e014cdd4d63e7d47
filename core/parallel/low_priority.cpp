#include "core/parallel/low_priority.h"

#include <sys/resource.h>
#include <unistd.h>

namespace nearfit {

void lowerThreadPriority() noexcept {
  constexpr int kLowest = 19;
  // Linux keeps the priority by thread, and takes a thread's number for a process'.
  (void)setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLowest);
}

}  // namespace nearfit
