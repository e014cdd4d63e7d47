#pragma once

#include <atomic>
#include <mutex>

#include "core/progress.h"

namespace nearfit {

/// Progress of work that several threads share: keeps the order that ProgressCallback promises, and tells all
/// of them when the user wants to stop.
class SharedProgress {
 public:
  /// @param total  What all calls of add() come to; > 0.
  SharedProgress(const ProgressCallback& callback, double total) : callback_(callback), total_(total) {}

  /// Any thread. Counts work as done; throws Cancelled once the callback has said stop.
  void add(double work);

 private:
  const ProgressCallback& callback_;
  const double total_;
  std::atomic<double> done_{0.0};
  std::atomic<bool> isCancelled_{false};
  std::mutex mutex_;       ///< Held while the callback runs.
  double reported_ = 0.0;  ///< Guarded by the mutex.
};

}  // namespace nearfit
