#include "core/proximity/query/merge_minima.h"

#include <algorithm>
#include <utility>

#include "core/proximity/query/flat_region.h"
#include "core/proximity/query/touching.h"

namespace nearfit {
namespace {

/// Finds the sets: makes `parent` lead from each entry to the first entry of its set.
class Grouping {
 public:
  Grouping(std::span<Minimum> minima, MergeWork& work, const TouchTolerances& closeness) noexcept
      : minima_(minima), work_(work), closeness_(closeness) {}

  MergeResult run() noexcept {
    work_.boxes.clear();
    for (std::uint32_t i = 0; i < minima_.size(); ++i) {
      work_.parent[i] = i;
      findSides(minima_[i], work_.sides[i]);
      work_.boxes.add(boxOf(minima_[i], closeness_.margin(minima_[i])));
    }
    work_.boxes.build();
    work_.boxes.forEachPair([this](std::uint32_t i, std::uint32_t j) { join(i, j); });
    // A parent precedes its children.
    for (std::uint32_t i = 0; i < minima_.size(); ++i)
      work_.parent[i] = work_.parent[work_.parent[i]];
    return counted_;
  }

 private:
  std::uint32_t root(std::uint32_t i) noexcept {
    std::vector<std::uint32_t>& parent = work_.parent;
    while (parent[i] != i)
      i = parent[i] = parent[parent[i]];
    return i;
  }

  void join(std::uint32_t i, std::uint32_t j) noexcept {
    ++counted_.pairs;
    const std::uint32_t ri = root(i), rj = root(j);
    // Of two entries in one set, only their overlap is left to find out. Most have none, which is soon seen.
    if (ri == rj && !mayMark(minima_[i], minima_[j])) return;
    if (featureKey(minima_[j]) < featureKey(minima_[i])) std::swap(i, j);
    if (ri == rj && !doOverlap(i, j)) return;
    Minimum &a = minima_[i], &b = minima_[j];
    if (!canTouch(a, b, closeness_)) return;
    const bool isOverlap = ri == rj || doOverlap(i, j);
    if (isOverlap) a.isOverlapping = b.isOverlapping = true;
    if (ri == rj) return;
    if (!isOverlap) ++counted_.touchings;
    if (isOverlap || touch(a, b, closeness_)) work_.parent[std::max(ri, rj)] = std::min(ri, rj);
  }

  bool doOverlap(std::uint32_t i, std::uint32_t j) const noexcept {
    const Minimum &a = minima_[i], &b = minima_[j];
    const double tolerance = closeness_.ofOverlap(std::max(a.lmd.distance, b.lmd.distance));
    return overlap({a, work_.sides[i]}, {b, work_.sides[j]}, tolerance);
  }

  static bool mayMark(const Minimum& a, const Minimum& b) noexcept {
    return a.dimension == b.dimension && a.dimension != 0 && !(a.isOverlapping && b.isOverlapping);
  }

  std::span<Minimum> minima_;
  MergeWork& work_;
  const TouchTolerances& closeness_;
  MergeResult counted_;
};

/// Writes the indices of the entries to `order`, set by set, the sets in order of their first entries.
void sortBySet(std::span<const std::uint32_t> parent, std::span<std::uint32_t> order,
               std::span<std::uint32_t> starts) noexcept {
  // First the size of each set, then the place of its next entry.
  std::fill(starts.begin(), starts.end(), 0U);
  for (const std::uint32_t root : parent)
    ++starts[root];
  std::uint32_t next = 0;
  for (std::uint32_t& start : starts)
    next += std::exchange(start, next);
  for (std::uint32_t i = 0; i < parent.size(); ++i)
    order[starts[parent[i]]++] = i;
}

void sortByFeatures(std::span<const Minimum> minima, std::span<std::uint32_t> set,
                    std::span<MergeWork::Key> keys) noexcept {
  keys = keys.first(set.size());
  for (std::size_t i = 0; i < set.size(); ++i)
    keys[i] = {featureKey(minima[set[i]]), set[i]};
  std::sort(keys.begin(), keys.end(), [](const auto& a, const auto& b) { return a.features < b.features; });
  for (std::size_t i = 0; i < set.size(); ++i)
    set[i] = keys[i].index;
}

void sortByDistance(std::span<const Minimum> minima, std::span<std::uint32_t> order) noexcept {
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double da = minima[a].lmd.distance, db = minima[b].lmd.distance;
    return da != db ? da < db : featureKey(minima[a]) < featureKey(minima[b]);
  });
}

}  // namespace

MergeResult mergeMinima(std::span<Minimum> minima, std::span<std::uint32_t> order, MergeWork& work,
                        double size, double smallerSize) noexcept {
  const TouchTolerances closeness(size, smallerSize);
  MergeResult result = Grouping(minima, work, closeness).run();
  const std::span<const std::uint32_t> parent = std::span(work.parent).first(minima.size());
  const std::span<std::uint32_t> sorted = order.first(minima.size());
  sortBySet(parent, sorted, std::span(work.starts).first(minima.size()));
  const RegionNeighbours neighbours{work.boxes, parent};
  for (std::size_t i = 0, end = 0; i < sorted.size(); i = end) {
    bool isRegion = false;
    for (; end < sorted.size() && parent[sorted[end]] == parent[sorted[i]]; ++end)
      isRegion = isRegion || minima[sorted[end]].dimension > 0;
    const std::span<std::uint32_t> set = sorted.subspan(i, end - i);
    if (set.size() > 1) sortByFeatures(minima, set, work.keys);
    // Neighbours claim a point at their common boundary by rounding; the one that surely owns it decides.
    const auto sure = std::find_if(set.begin(), set.end(),
                                   [&](std::uint32_t m) { return isRegion || !minima[m].lmd.isMarginal; });
    const std::uint32_t first = sure == set.end() ? set.front() : *sure;
    if (isRegion) {
      const double tolerance = closeness.ofOverlap(minima[first].lmd.distance);
      minima[first].lmd = uniteRegion(minima, set, neighbours, tolerance);
    }
    order[result.count++] = first;
  }
  sortByDistance(minima, order.first(result.count));
  return result;
}

}  // namespace nearfit
