#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/proximity/minimum.h"

namespace nearfit {

/// Makes one minimum of each set of entries that touch each other at one distance: neighbouring features that
/// claim a minimum at their common boundary, and the pieces of a flat region with the points at its rim:
/// where faces are parallel only to kFlatTolerance, one of those points is the minimum and the region stands
/// for it. The first `return value` entries of `order` then name the results in `minima`, nearest first,
/// regions as their centroids.
///
/// @param order, parent  Work space, as long as `minima`.
/// @param size           Of both bodies together [m], for tolerances.
/// @param smallerSize    Of the smaller body [m].
/// Real-time safe. A sort and a sweep: entries that overlap along the axis of the sweep are held against each
/// other.
std::size_t mergeMinima(std::span<Minimum> minima, std::span<std::uint32_t> order,
                        std::span<std::uint32_t> parent, double size, double smallerSize) noexcept;

}  // namespace nearfit
