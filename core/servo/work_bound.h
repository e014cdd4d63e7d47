#pragma once

#include <cstdint>

#include "core/haptics/haptic_settings.h"
#include "core/servo/contact_finder.h"
#include "core/servo/minima_finder.h"

namespace nearfit {

/// Max work of a tick (`ServoSnapshot::work`, in units of some 50 ns on a slow core).
///
/// Proxy mode: 45,184, some 2 ms on a slow core. Contacts, on which the part's motion depends, get most of it,
/// for gathering pairs from the longest list; their tests end at ContactFinder::kUsualWork and go on in the next
/// tick. Minima, which are only shown, get the rest and are truncated there, and less in a tick that contacts fill.
/// Usual ticks stay below a twentieth. Every search is told how much work is left, and does not start, or abandons,
/// what would exceed it; a part of which too little is known stays where it was proved free.
///
/// Springs mode: 36 million. The minima decide the force: a missing one makes the force jump, and a late tick
/// does less harm. All are merged as far as the work space goes: 16,384 pieces a tick (and 4,096 minima a
/// body). That many, flat on each other, take some 20 ms. The bound covers the worst conceivable case, where
/// each of their boxes overlaps all others. A million of them are for merging areas of contact, if that is asked for.
constexpr std::uint64_t mostWork(HapticMode mode) noexcept {
  return mode == HapticMode::Springs ? MinimaFinder::kFeltByArea.most()
                                     : ContactFinder::kMaxWork + MinimaFinder::kShown.most();
}

}  // namespace nearfit
