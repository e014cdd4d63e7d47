#include "tests/support/limited_process.h"

#include <fstream>
#include <stdexcept>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace nearfit::test {
namespace {

#ifdef NEARFIT_SANITIZED
constexpr bool kLimitsMemory = false;
#else
constexpr bool kLimitsMemory = true;
#endif

/// Address space of this process [bytes].
std::size_t addressSpace() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

void limit(__rlimit_resource resource, std::size_t value) {
  const rlimit both{value, value};
  ::setrlimit(resource, &both);
}

}  // namespace

LimitedOutcome runLimited(const std::function<int()>& work, std::size_t memoryBytes, unsigned cpuSeconds) {
  const ::pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("cannot fork");
  if (child == 0) {
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, cpuSeconds);
    if (kLimitsMemory) limit(RLIMIT_AS, addressSpace() + memoryBytes);
    int result = 255;
    try {
      result = work();
    } catch (...) {
      // 255 says so.
    }
    ::_exit(result);
  }
  int status = 0;
  if (::waitpid(child, &status, 0) != child) throw std::runtime_error("cannot wait");
  if (WIFEXITED(status)) return {true, WEXITSTATUS(status), 0};
  return {false, 0, WIFSIGNALED(status) ? WTERMSIG(status) : 0};
}

}  // namespace nearfit::test
