#pragma once

#include <cstdint>

#include "core/haptics/contact_finder.h"
#include "core/haptics/haptic_settings.h"
#include "core/haptics/minima_finder.h"

namespace nearfit {

/// No tick does more work than this (`ServoSnapshot::work`, in units of some 50 ns on a slow core).
///
/// In the proxy mode 73,856: some 3.7 ms there. Contacts, which the part's way depends on, have nearly half
/// of it; minima, which are only shown, the rest, and are truncated there. Few ticks come near: usual ones
/// stay under a twentieth. Whatever takes work is given how much is left, and does not begin, or leaves off,
/// what would go beyond: a part of which too little is known stands where it was proved to be free.
///
/// In the direct mode the minima decide the force: one left out is a force that jumps, and a tick that is
/// late does less harm. All are merged as far as the work space goes, 16,384 pieces a tick (and 4,096 minima
/// a body). As many lying flat on each other take some 20 ms; the bound, 34 million, is for the worst that is
/// thinkable, where each of their boxes overlaps each other.
constexpr std::uint64_t mostWork(HapticMode mode) noexcept {
  return mode == HapticMode::Springs ? MinimaFinder::kFelt.most()
                                     : ContactFinder::kMaxWork + MinimaFinder::kShown.most();
}

}  // namespace nearfit
