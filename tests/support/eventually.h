#pragma once

#include <chrono>
#include <thread>

namespace nearfit::test {

/// What takes longer never comes: far beyond any stall of a loaded machine, so that time decides no test.
constexpr std::chrono::seconds kPatience{60};

/// Waits for what another thread brings about; false when it does not come within kPatience.
template <class Condition>
bool eventually(Condition&& isTrue) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (std::chrono::steady_clock::now() < end) {
    if (isTrue()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return isTrue();
}

}  // namespace nearfit::test
