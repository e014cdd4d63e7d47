#pragma once

#include <cstddef>
#include <functional>

namespace nearfit::test {

/// How a piece of work in a process of its own ended.
struct LimitedOutcome {
  bool hasEnded = false;  ///< False: it crashed or was killed at a limit.
  int result = 0;         ///< What the work returned (0 to 255).
  int signal = 0;         ///< What killed it.
};

/// Runs `work` in a copy of this process with at most `memoryBytes` more address space than now and
/// `cpuSeconds` of processor time. Sanitizers reserve address space at will: under them only time is limited.
LimitedOutcome runLimited(const std::function<int()>& work, std::size_t memoryBytes, unsigned cpuSeconds);

}  // namespace nearfit::test
