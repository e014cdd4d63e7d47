#pragma once

#include <atomic>
#include <mutex>

#include "core/base/progress.h"

namespace nearfit {

/// Progress of work shared by several threads. Keeps the guarantees of ProgressCallback (one call at a time,
/// never falling) and stops all threads when the user cancels.
class SharedProgress {
 public:
  /// @param callback  Must outlive this object; may be empty.
  /// @param total     Sum of the work of all calls of add(); > 0.
  SharedProgress(const ProgressCallback& callback, double total) : callback_(callback), total_(total) {}

  /// Adds to the work done, and reports it. Any thread. Throws Cancelled once the callback has
  /// returned false.
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
