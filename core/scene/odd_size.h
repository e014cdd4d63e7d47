#pragma once

#include <optional>
#include <span>

#include "core/scene/scene.h"

namespace nearfit {

/// How many times larger than the largest other part, or smaller than the smallest, parts must be for their
/// unit to be doubted: fewer than the thousand from millimetres to metres, since parts differ among
/// themselves.
constexpr double kOddSizeRatio = 300.0;

/// Parts that their unit seems to have made far too large or too small.
struct OddSize {
  double ratio = 1.0;   ///< Of their size to that of the others: > 1 when they are too large.
  double factor = 1.0;  ///< Their size times this is near the others'; from one unit of CAD to another.
};

/// Whether these parts, which came together, are all out of proportion to all others, by the diagonals of
/// their boxes; empty when they are not, when there are no others, and when no change of unit would bring
/// them nearer. O(parts). Parts that the scene does not have are left out.
std::optional<OddSize> oddSizeOf(const Scene& scene, std::span<const PartId> parts);

}  // namespace nearfit
