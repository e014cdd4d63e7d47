#pragma once

#include <functional>

namespace nearfit {

/// Called during long work with the fraction done: 0 to 1, never decreasing. Return false to stop the work,
/// which then throws Cancelled. Calls may come from several threads, but never concurrently. May be empty.
using ProgressCallback = std::function<bool(double fraction)>;

}  // namespace nearfit
