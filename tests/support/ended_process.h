#pragma once

#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

namespace nearfit::test {

/// Id of a process that has ended: no process has it from now on until the system wraps around.
inline ::pid_t endedProcess() {
  const ::pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ::waitpid(child, nullptr, 0);
  return child;
}

}  // namespace nearfit::test
