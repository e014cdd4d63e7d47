#include "tests/usb/driver_bench.h"

#include <cstdlib>
#include <thread>

#include <glm/matrix.hpp>

#include "device/thread/monotonic_clock.h"

namespace nearfit::test {
namespace {

constexpr std::chrono::microseconds kPollPause{20};

}  // namespace

SafetyLimits safetyWith(double silence) {
  SafetyLimits safety;
  safety.patience = {silence, silence};
  return safety;
}

SafetyLimits lenientSafety() {
  return safetyWith(2.0 * toSeconds(std::chrono::nanoseconds(kPatience).count()));
}

glm::dvec3 forceFor(const glm::dvec3& told, const std::function<glm::dvec3(const glm::dvec3&)>& tell) {
  const glm::dmat3 columns(tell({1.0, 0.0, 0.0}), tell({0.0, 1.0, 0.0}), tell({0.0, 0.0, 1.0}));
  return glm::inverse(columns) * told;
}

bool promptly(const std::function<bool()>& isTrue) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!isTrue()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(kPollPause);
  }
  return true;
}

int toAndFro(int i, int most) {
  const int at = (i + most) % (4 * most);
  return most - std::abs(at - 2 * most);
}

}  // namespace nearfit::test
