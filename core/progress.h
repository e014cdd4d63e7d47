#pragma once

#include <functional>

namespace nearfit {

/// Called now and then during long work with the fraction done, 0 to 1, never falling. Returns false to stop
/// the work, which then throws Cancelled. Calls may come from several threads, but never two at once. May be
/// empty.
using ProgressCallback = std::function<bool(double fraction)>;

}  // namespace nearfit
