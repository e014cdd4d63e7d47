#include "device/thread/realtime_thread.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace nearfit {
namespace {

/// Above ordinary threaded interrupts (50), below the kernel's own watchdogs.
constexpr int kPriority = 70;

/// More than a tick and a query use.
constexpr std::size_t kStackBytes = std::size_t{256} * 1024;

/// Locking affects the whole process: the last servo to end unlocks it.
std::atomic<int> memoryLocks{0};

int setFifo(int priority) noexcept {
  sched_param parameters{};
  parameters.sched_priority = priority;
  return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
}

__attribute__((noinline)) void touchStack() noexcept {
  unsigned char stack[kStackBytes];
  volatile unsigned char* const bytes = stack;
  for (std::size_t i = 0; i < kStackBytes; i += 1024)
    bytes[i] = 0;
}

bool mayLockWithoutLimit() noexcept {
  rlimit limit{};
  if (::getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3]{};
  if (::syscall(SYS_capget, &header, data) != 0) return false;
  return (data[0].effective & (1U << CAP_IPC_LOCK)) != 0;
}

}  // namespace

void requestRealtimeScheduling(RealtimeGrant& grant) noexcept {
  ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  touchStack();
  int priority = kPriority;
  int error = setFifo(priority);
  rlimit limit{};
  if (error != 0 && ::getrlimit(RLIMIT_RTPRIO, &limit) == 0 && limit.rlim_cur > 0) {
    priority = static_cast<int>(std::min<rlim_t>(limit.rlim_cur, kPriority));
    error = setFifo(priority);
  }
  grant.priority = error == 0 ? priority : 0;
  grant.schedulingError = error;
}

MemoryLock::MemoryLock(RealtimeGrant& grant) noexcept {
  if (mayLockWithoutLimit()) {
    // On fault: the servo's memory was touched when it was made. Filling in every stack and reserve of the
    // program would take seconds and gigabytes.
    isLocked_ = ::mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) == 0;
    grant.lockError = isLocked_ ? 0 : errno;
  } else {
    grant.lockError = EPERM;
  }
  grant.isMemoryLocked = isLocked_;
  if (isLocked_) memoryLocks.fetch_add(1);
}

MemoryLock::~MemoryLock() {
  if (isLocked_ && memoryLocks.fetch_sub(1) == 1) ::munlockall();
}

AwakeProcessors::AwakeProcessors(RealtimeGrant& grant, const char* device) noexcept
    : file_(::open(device, O_WRONLY | O_CLOEXEC)) {
  grant.awakeError = file_ < 0 ? errno : 0;
  if (file_ < 0) return;
  constexpr std::int32_t kLongestWake = 0;  // [us]
  if (::write(file_, &kLongestWake, sizeof kLongestWake) != sizeof kLongestWake) grant.awakeError = errno;
  grant.areProcessorsAwake = grant.awakeError == 0;
}

AwakeProcessors::~AwakeProcessors() {
  if (file_ >= 0) ::close(file_);
}

std::string RealtimeGrant::describe() const {
  const std::string scheduling = priority > 0
                                     ? fmt::format("SCHED_FIFO {}", priority)
                                     : fmt::format("no SCHED_FIFO ({}), so ticks may be late under load",
                                                   std::strerror(schedulingError));
  std::string text = scheduling;
  if (isMemoryLocked) text += ", memory locked";
  if (lockError != 0) text += fmt::format(", memory not locked ({})", std::strerror(lockError));
  if (areProcessorsAwake) text += ", processors kept awake";
  if (awakeError == EACCES || awakeError == EPERM)
    text += fmt::format(", processors may sleep ({}; Nearfit's udev rules permit keeping them awake)",
                        std::strerror(awakeError));
  if (priority == 0 || lockError != 0) {
    text +=
        "; to permit it, put \"USER - rtprio 70\" and \"USER - memlock unlimited\", with your user name for "
        "USER, in /etc/security/limits.d/nearfit.conf and log in again";
  }
  return text;
}

}  // namespace nearfit
