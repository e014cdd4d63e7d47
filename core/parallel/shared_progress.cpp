#include "core/parallel/shared_progress.h"

#include <algorithm>

#include "core/base/error.h"

namespace nearfit {

void SharedProgress::add(double work) {
  const double done = done_.fetch_add(work) + work;
  if (!callback_) return;
  // If another thread is reporting, skip this report: the next one includes it.
  if (const std::unique_lock lock(mutex_, std::try_to_lock); lock && !isCancelled_) {
    reported_ = std::max(reported_, std::clamp(done / total_, 0.0, 1.0));
    if (!callback_(reported_)) isCancelled_ = true;
  }
  if (isCancelled_) throw Cancelled();
}

}  // namespace nearfit
