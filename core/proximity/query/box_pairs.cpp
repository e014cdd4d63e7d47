#include "core/proximity/query/box_pairs.h"

#include <algorithm>

#include <glm/common.hpp>

namespace nearfit {
namespace {

constexpr std::uint32_t kLeafEntries = 8;

/// Each side of a split gets at least 1/kMinShare of the entries: for a million, at most a hundred levels.
constexpr std::uint32_t kMinShare = 8;

/// Min entries of a child; keeps nodes fewer than entries.
constexpr std::uint32_t kMinEntries = 3;

/// Twice the centre along an axis.
double middle(const Aabb& box, int axis) noexcept {
  return box.lower[axis] + box.upper[axis];
}

}  // namespace

BoxPairs::BoxPairs(std::size_t capacity) : entries_(capacity), nodes_(std::max<std::size_t>(capacity, 1)) {}

void BoxPairs::add(const Aabb& box) noexcept {
  entries_[count_] = {box, count_};
  ++count_;
}

void BoxPairs::build() noexcept {
  nodeCount_ = 0;
  if (count_ > 0) makeNode(0, count_);
}

std::uint32_t BoxPairs::makeNode(std::uint32_t begin, std::uint32_t end) noexcept {
  const std::uint32_t at = nodeCount_++;
  if (end - begin <= kLeafEntries) {
    Aabb box;
    for (std::uint32_t i = begin; i < end; ++i) {
      box.lower = glm::min(box.lower, entries_[i].box.lower);
      box.upper = glm::max(box.upper, entries_[i].box.upper);
    }
    nodes_[at] = {box, begin, end, 0};
    return at;
  }
  const std::uint32_t cut = split(begin, end);
  const std::uint32_t left = makeNode(begin, cut), right = makeNode(cut, end);
  const Aabb &a = nodes_[left].box, &b = nodes_[right].box;
  nodes_[at] = {{glm::min(a.lower, b.lower), glm::max(a.upper, b.upper)}, begin, end, right};
  return at;
}

/// Splits at the middle of the centres along their longest axis or, if that is too uneven, at the median.
std::uint32_t BoxPairs::split(std::uint32_t begin, std::uint32_t end) noexcept {
  Aabb middles;
  for (std::uint32_t i = begin; i < end; ++i)
    middles.add(entries_[i].box.lower + entries_[i].box.upper);
  const glm::dvec3 spread = middles.upper - middles.lower;
  int axis = spread.y > spread.x ? 1 : 0;
  if (spread.z > spread[axis]) axis = 2;
  const auto first = entries_.begin() + begin, last = entries_.begin() + end;
  const double cut = middles.centre()[axis];
  const auto at = std::partition(first, last, [&](const Entry& e) { return middle(e.box, axis) < cut; });
  const auto least = std::max(kMinEntries, (end - begin) / kMinShare);
  if (at - first >= least && last - at >= least) return static_cast<std::uint32_t>(at - entries_.begin());
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(first, entries_.begin() + half, last,
                   [&](const Entry& a, const Entry& b) { return middle(a.box, axis) < middle(b.box, axis); });
  return half;
}

}  // namespace nearfit
