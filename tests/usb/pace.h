#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <thread>

namespace nearfit::test {

/// What is done at a rate; what is late is not made up for by a burst.
class Pace {
 public:
  explicit Pace(double rate) : period_(static_cast<std::int64_t>(1e9 / rate)) {}
  void wait() {
    std::this_thread::sleep_until(due_);
    due_ = std::max(due_ + period_, std::chrono::steady_clock::now());
  }

 private:
  const std::chrono::nanoseconds period_;
  std::chrono::steady_clock::time_point due_ = std::chrono::steady_clock::now();
};

}  // namespace nearfit::test
