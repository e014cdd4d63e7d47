#pragma once

#include <functional>

#include "core/base/error.h"

namespace nearfit {

/// Called during long work with the fraction done: 0 to 1, never decreasing. Return false to stop the work,
/// which then throws Cancelled. Calls may come from several threads, but never concurrently. May be empty.
using ProgressCallback = std::function<bool(double fraction)>;

/// Progress of a stage that takes the whole from one fraction to another.
/// @param progress  Kept by reference.
inline ProgressCallback stageCallback(const ProgressCallback& progress, double from, double to) {
  return
      [&progress, from, to](double fraction) { return !progress || progress(from + (to - from) * fraction); };
}

/// The same for work that is stopped by an exception: throws Cancelled where the callback returns false.
inline std::function<void(double fraction)> stageOf(const ProgressCallback& progress, double from,
                                                    double to) {
  return [report = stageCallback(progress, from, to)](double fraction) {
    if (!report(fraction)) throw Cancelled();
  };
}

}  // namespace nearfit
