#include "core/math/box_pairs.h"

#include <algorithm>

#include <glm/common.hpp>

#include "core/math/box_split.h"

namespace nearfit {
namespace {

constexpr std::uint32_t kLeafEntries = 8;

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
  const std::span<Entry> entries = std::span(entries_).subspan(begin, end - begin);
  const std::uint32_t cut = begin + static_cast<std::uint32_t>(splitBoxes(entries));
  const std::uint32_t left = makeNode(begin, cut), right = makeNode(cut, end);
  const Aabb &a = nodes_[left].box, &b = nodes_[right].box;
  nodes_[at] = {{glm::min(a.lower, b.lower), glm::max(a.upper, b.upper)}, begin, end, right};
  return at;
}

}  // namespace nearfit
