#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace nearfit::stress {

/// What a scene gets of a long run at least [ticks]: 125 episodes of HandRun's settings. Seven of these are
/// on or off, and so nearly every combination of them comes up.
constexpr std::uint64_t kMinTicks = 100'000;

/// Ticks of each scene, `total` in all: so many that each scene takes the same time, but kMinTicks at
/// least; equally many where there are not as many for each.
/// @param costs  Of a tick of each scene, in any unit; > 0.
std::vector<std::uint64_t> shareTicks(std::span<const double> costs, std::uint64_t total);

}  // namespace nearfit::stress
