#pragma once

#include <cstdint>

#include "core/haptics/contact_finder.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/minima_finder.h"

namespace nearfit {

/// Max work of a tick (`ServoSnapshot::work`, in units of some 50 ns on a slow core).
///
/// In the proxy mode 73,856: some 3.7 ms there. Contacts, which the part's way depends on, have nearly half
/// of it; minima, which are only shown, have the rest, and are truncated there. Usual ticks stay below a
/// twentieth. Whatever takes work is told how much is left, and does not start, or abandons, what would
/// exceed it: a part of which too little is known stands where it was proved to be free.
///
/// In the springs mode the minima decide the force: a missing one makes the force jump, and a late tick does
/// less harm. All are merged as far as the work space goes: 16,384 pieces a tick (and 4,096 minima a body).
/// As many, flat on each other, take some 20 ms; the bound, 34 million, is for the worst conceivable case,
/// where all their boxes overlap each other.
constexpr std::uint64_t mostWork(HapticMode mode) noexcept {
  return mode == HapticMode::Springs ? MinimaFinder::kFelt.most()
                                     : ContactFinder::kMaxWork + MinimaFinder::kShown.most();
}

}  // namespace nearfit
