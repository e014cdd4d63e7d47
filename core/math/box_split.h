#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "core/math/aabb.h"

namespace nearfit {

/// Each side of a split gets at least 1/kMinBoxShare of the boxes, so that the hierarchy of a million has at
/// most a hundred levels, and at least kMinBoxes, so that there are fewer nodes than boxes.
constexpr std::size_t kMinBoxShare = 8, kMinBoxes = 3;

/// Splits boxes for a binary hierarchy: at the middle of their centres along the longest axis of these or, if
/// that is too uneven, at the median. Reorders the entries and returns the size of the first part. O(n).
/// Real-time safe.
///
/// @tparam Entry    Has a member `box`, an Aabb.
/// @param  entries  At least 2 * kMinBoxes.
template <class Entry>
std::size_t splitBoxes(std::span<Entry> entries) noexcept {
  // Twice the centre along an axis.
  const auto middle = [](const Entry& e, int axis) { return e.box.lower[axis] + e.box.upper[axis]; };
  Aabb middles;
  for (const Entry& entry : entries)
    middles.add(entry.box.lower + entry.box.upper);
  const glm::dvec3 spread = middles.upper - middles.lower;
  int axis = spread.y > spread.x ? 1 : 0;
  if (spread.z > spread[axis]) axis = 2;
  const double cut = middles.centre()[axis];
  const auto at =
      std::partition(entries.begin(), entries.end(), [&](const Entry& e) { return middle(e, axis) < cut; });
  const auto first = static_cast<std::size_t>(at - entries.begin());
  const std::size_t least = std::max(kMinBoxes, entries.size() / kMinBoxShare);
  if (first >= least && entries.size() - first >= least) return first;
  const std::size_t half = entries.size() / 2;
  std::nth_element(entries.begin(), entries.begin() + static_cast<std::ptrdiff_t>(half), entries.end(),
                   [&](const Entry& a, const Entry& b) { return middle(a, axis) < middle(b, axis); });
  return half;
}

}  // namespace nearfit
