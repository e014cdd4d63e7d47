#pragma once

#include <chrono>
#include <functional>

#include "tests/bench/hour_row.h"

namespace nearfit::bench {

/// How long the demo stays in hand with its window open, and how often a row is made.
struct HourOptions {
  std::chrono::milliseconds time{3'600'000}, every{60'000};
};

/// Opens the demo in the window, has the scripted hand press it into contact again and again, and calls `tell` at the
/// end of each stretch of time. Needs a display, and waits for the wall clock.
/// @throw Error if the demo does not open or the hand touches nothing all along.
void keepWindowOpen(const HourOptions& options, const std::function<void(const HourRow&)>& tell);

}  // namespace nearfit::bench
