#include "core/parallel/parallel_for.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace nearfit {
namespace {

/// Helper threads that the process may still start, besides the threads that call parallelFor(). Below zero: so many of those
/// that run are too many, since processors were reserved after they had started.
std::atomic<int>& freeHelpers() {
  static std::atomic<int> count{static_cast<int>(std::max(1U, std::thread::hardware_concurrency())) - 1};
  return count;
}

/// Permission to run one helper thread; returned on destruction.
class HelperPermit {
 public:
  static std::optional<HelperPermit> take() {
    int count = freeHelpers().load(std::memory_order_relaxed);
    while (count > 0) {
      if (freeHelpers().compare_exchange_weak(count, count - 1)) return HelperPermit();
    }
    return std::nullopt;
  }
  HelperPermit(HelperPermit&& other) noexcept : isHeld_(std::exchange(other.isHeld_, false)) {}
  HelperPermit& operator=(HelperPermit&&) = delete;
  ~HelperPermit() {
    if (isHeld_) ++freeHelpers();
  }

 private:
  HelperPermit() = default;
  bool isHeld_ = true;
};

class ParallelLoop {
 public:
  ParallelLoop(std::size_t count, const std::function<void(std::size_t)>& work)
      : count_(count), work_(work) {}

  void run() {
    for (std::size_t i = next_++; i < count_; i = next_++) {
      hireHelpers();
      attempt(i);
    }
    for (std::thread& helper : helpers_)
      helper.join();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  /// Called only by the thread that started the loop, before each item: other loops may have
  /// released helpers.
  void hireHelpers() {
    while (next_.load(std::memory_order_relaxed) < count_) {
      std::optional<HelperPermit> permit = HelperPermit::take();
      if (!permit) return;
      try {
        helpers_.emplace_back([this, held = std::move(*permit)] {
          for (std::size_t i = next_++; i < count_; i = next_++) {
            attempt(i);
            // Several may leave where one is too many: the caller hires again.
            if (freeHelpers().load(std::memory_order_relaxed) < 0) return;
          }
        });
      } catch (const std::system_error&) {
        return;  // No thread available; this thread does the work.
      }
    }
  }

  void attempt(std::size_t i) noexcept {
    try {
      work_(i);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      next_ = count_;
    }
  }

  const std::size_t count_;
  const std::function<void(std::size_t)>& work_;
  std::atomic<std::size_t> next_{0};
  std::vector<std::thread> helpers_;
  std::mutex mutex_;
  std::exception_ptr error_;
};

}  // namespace

ReservedProcessor::ReservedProcessor() noexcept {
  --freeHelpers();
}

ReservedProcessor::~ReservedProcessor() {
  ++freeHelpers();
}

void parallelFor(std::size_t count, const std::function<void(std::size_t)>& work) {
  ParallelLoop(count, work).run();
}

}  // namespace nearfit
