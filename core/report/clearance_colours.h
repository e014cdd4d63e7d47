#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/report/clearance_map.h"
#include "core/scene/part.h"

namespace nearfit {

/// Colours of clearances from contact to the range, equally spaced: told apart with the common forms of colour blindness,
/// with red for near as for minima.
/// Source: C. Brewer, ColorBrewer 2.0, 2013: the diverging scheme RdYlBu of eleven classes.
constexpr std::array<Colour, 11> kClearanceStops{{
    {0.647F, 0.000F, 0.149F},
    {0.843F, 0.188F, 0.153F},
    {0.957F, 0.427F, 0.263F},
    {0.992F, 0.682F, 0.380F},
    {0.996F, 0.878F, 0.565F},
    {1.000F, 1.000F, 0.749F},
    {0.878F, 0.953F, 0.973F},
    {0.671F, 0.851F, 0.914F},
    {0.455F, 0.678F, 0.820F},
    {0.271F, 0.459F, 0.706F},
    {0.192F, 0.212F, 0.584F},
}};
/// Where a surface is inside another part: darker than any of them.
constexpr Colour kOverlapColour{0.11F, 0.05F, 0.10F};

/// Colour of a clearance within the range; kOverlapColour from a depth of kContactDistance on.
/// @param range  [m]; > 0.
inline Colour clearanceColour(double distance, double range) noexcept {
  if (distance < -kContactDistance) return kOverlapColour;
  const double position =
      std::clamp(distance / range, 0.0, 1.0) * static_cast<double>(kClearanceStops.size() - 1);
  const auto lower = std::min(static_cast<std::size_t>(position), kClearanceStops.size() - 2);
  const auto share = static_cast<float>(position - static_cast<double>(lower));
  const Colour &a = kClearanceStops[lower], &b = kClearanceStops[lower + 1];
  return {a.r + share * (b.r - a.r), a.g + share * (b.g - a.g), a.b + share * (b.b - a.b)};
}

}  // namespace nearfit
