#pragma once

#include <fstream>
#include <string>

#include <sys/types.h>

#include "core/recovery/recovery_folder.h"

namespace nearfit::test {

/// Of another process that runs, whose name holds no blank: when it began is the twenty-second word there.
inline ProcessIdentity identityOf(::pid_t pid) {
  std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
  std::string word;
  for (int i = 0; i < 21; ++i)
    stat >> word;
  ProcessIdentity identity = thisProcess();
  identity.pid = pid;
  stat >> identity.start;
  return identity;
}

}  // namespace nearfit::test
