#pragma once

#include <optional>
#include <span>

#include "core/scene/scene.h"

namespace nearfit {

/// Size ratio beyond which a unit is doubted. Less than the thousand between millimetres and metres, since
/// parts of one scene differ in size.
constexpr double kOddSizeRatio = 300.0;

/// Parts that are far too large or too small, probably because of a wrong unit.
struct OddSize {
  double ratio = 1.0;  ///< Their size over that of the others; > 1 if they are too large.
  /// Factor on metresPerUnit, to a common CAD unit, that brings their size nearest to the others'.
  double factor = 1.0;
};

/// Checks whether all these parts are out of proportion to all other parts, by the diagonals of their
/// bounding boxes. Returns std::nullopt if they are not, if there are no others, or if no change of unit
/// would help. Ignores parts that are not in the scene. O(n log n).
std::optional<OddSize> oddSizeOf(const Scene& scene, std::span<const PartId> parts);

/// A part whose own size is odd.
struct OddPart {
  PartId part{};
  OddSize size;
};
/// The first of these parts for which oddSizeOf() it alone returns a value. O(n log n) for all together.
std::optional<OddPart> firstOddPart(const Scene& scene, std::span<const PartId> parts);

}  // namespace nearfit
