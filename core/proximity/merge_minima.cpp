#include "core/proximity/merge_minima.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <glm/geometric.hpp>

#include "core/math/aabb.h"
#include "core/math/tolerances.h"
#include "core/proximity/flat_region.h"

namespace nearfit {
namespace {

double pointSegmentDistance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) noexcept {
  const glm::dvec3 e = b - a;
  const double ee = glm::dot(e, e);
  const double s = ee > 0.0 ? std::clamp(glm::dot(p - a, e) / ee, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + s * e);
}

double segmentDistance(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                       const glm::dvec3& d) noexcept {
  // In one plane, segments that do not cross are nearest at an end.
  double nearest = std::min({pointSegmentDistance(a, c, d), pointSegmentDistance(b, c, d),
                             pointSegmentDistance(c, a, b), pointSegmentDistance(d, a, b)});
  const glm::dvec3 e = b - a, f = d - c, n = glm::cross(e, f);
  const double nn = glm::dot(n, n);
  if (nn > 0.0) {
    const double s = glm::dot(glm::cross(c - a, f), n) / nn, t = glm::dot(glm::cross(c - a, e), n) / nn;
    if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0)
      nearest = std::min(nearest, glm::distance(a + s * e, c + t * f));
  }
  return nearest;
}

/// Convex sets of one plane: distance between outlines, or 0 when one holds a corner of the other.
class Piece {
 public:
  explicit Piece(const Minimum& m) : m_(m) {}

  std::size_t sides() const noexcept { return m_.dimension == 2 ? m_.cornerCount : 1; }
  const glm::dvec3& from(std::size_t i) const noexcept {
    return m_.dimension == 0 ? m_.lmd.scenePoint : m_.corners[i];
  }
  const glm::dvec3& to(std::size_t i) const noexcept {
    return m_.dimension == 0 ? m_.lmd.scenePoint : m_.corners[(i + 1) % m_.cornerCount];
  }
  bool contains(const glm::dvec3& p) const noexcept {
    if (m_.dimension != 2) return false;
    bool left = true, right = true;
    for (std::size_t i = 0; i < m_.cornerCount; ++i) {
      const double turn = glm::dot(glm::cross(to(i) - from(i), p - from(i)), m_.lmd.direction);
      left = left && turn >= 0.0;
      right = right && turn <= 0.0;
    }
    return left || right;
  }
  /// Ends along an axis.
  double low(int axis) const noexcept {
    double least = from(0)[axis];
    for (std::size_t i = 1; i < m_.cornerCount; ++i)
      least = std::min(least, m_.corners[i][axis]);
    return least;
  }
  double high(int axis) const noexcept {
    double most = from(0)[axis];
    for (std::size_t i = 1; i < m_.cornerCount; ++i)
      most = std::max(most, m_.corners[i][axis]);
    return most;
  }
  /// Of a sphere about the scene point that holds it.
  double radius() const noexcept { return m_.dimension == 0 ? 0.0 : m_.radius; }

 private:
  const Minimum& m_;
};

/// An order that does not depend on when entries were found, and so not on the instruction set or a candidate
/// list: results are then the same to the last bit.
bool comesBefore(const Lmd& a, const Lmd& b) noexcept {
  const auto key = [](const Lmd& l) {
    return std::tuple(l.sceneFeature, l.sceneIndex, l.partFeature, l.partIndex);
  };
  return key(a) < key(b);
}

/// What counts as one length, for points and for pieces of flat regions.
struct Closeness {
  double base, gap;  ///< [m]

  /// Of two points of the scene that belong to minima whose directions differ.
  double of(const Minimum& a, const Minimum& b) const noexcept {
    const double distance = std::max(a.lmd.distance, b.lmd.distance);
    if (a.dimension == 0 && b.dimension == 0) return kMergeFactor * (base + kAngularTolerance * distance);
    const double turn = kMergeFactor * kFlatTolerance + glm::distance(a.lmd.direction, b.lmd.direction);
    return kMergeFactor * base + gap + turn * distance;
  }
  /// By how much neighbouring pieces may overlap that only lie in planes which differ a little.
  double ofOverlap(double distance) const noexcept {
    return kMergeFactor * (base + kFlatTolerance * distance);
  }
  /// Of the distances of minima that may be one: over a region that is not quite flat they differ.
  static double ofDistances(const Minimum& a, const Minimum& b, double lengths) noexcept {
    return lengths + 2.0 * kFlatTolerance * (Piece(a).radius() + Piece(b).radius());
  }
};

bool touch(const Minimum& a, const Minimum& b, double tolerance) noexcept {
  if (a.dimension == 0 && b.dimension == 0) {
    return glm::distance(a.lmd.scenePoint, b.lmd.scenePoint) <= tolerance &&
           glm::distance(a.lmd.partPoint, b.lmd.partPoint) <= tolerance;
  }
  const Piece pa(a), pb(b);
  if (pa.contains(b.lmd.scenePoint) || pb.contains(a.lmd.scenePoint)) return true;
  for (std::size_t i = 0; i < pa.sides(); ++i) {
    for (std::size_t j = 0; j < pb.sides(); ++j) {
      if (segmentDistance(pa.from(i), pa.to(i), pb.from(j), pb.to(j)) <= tolerance) return true;
    }
  }
  return false;
}

/// Whether a piece and another entry can be of one region at all.
bool canTouch(const Minimum& a, const Minimum& b, double tolerance) noexcept {
  if (a.dimension == 0 && b.dimension == 0) return true;
  if (glm::distance(a.lmd.direction, b.lmd.direction) > kRegionDirection) return false;
  const double radii = Piece(a).radius() + Piece(b).radius(), reach = radii + tolerance;
  const glm::dvec3 apart = a.lmd.scenePoint - b.lmd.scenePoint;
  if (glm::dot(apart, apart) > reach * reach) return false;
  // Two steps of the scene may face two steps of the part at one distance: regions one behind the other.
  const glm::dvec3& across = a.dimension > b.dimension ? a.lmd.direction : b.lmd.direction;
  return std::abs(glm::dot(apart, across)) <= tolerance + 2.0 * kFlatTolerance * radii;
}

std::uint32_t findRoot(std::span<std::uint32_t> parent, std::uint32_t i) noexcept {
  while (parent[i] != i)
    i = parent[i] = parent[parent[i]];
  return i;
}

/// Finds which entries belong together: `parent` then leads from each to the first of its set.
class Grouping {
 public:
  Grouping(std::span<Minimum> minima, std::span<std::uint32_t> order, std::span<std::uint32_t> parent,
           const Closeness& closeness) noexcept
      : minima_(minima),
        order_(order.first(minima.size())),
        parent_(parent.first(minima.size())),
        closeness_(closeness) {}

  /// A sweep along the axis on which they overlap least: what touches overlaps there.
  void sweep() noexcept {
    Aabb box;
    glm::dvec3 lengths(0.0);
    for (std::uint32_t i = 0; i < minima_.size(); ++i) {
      order_[i] = parent_[i] = i;
      for (int axis = 0; axis < 3; ++axis)
        lengths[axis] += Piece(minima_[i]).high(axis) - Piece(minima_[i]).low(axis);
      box.add(minima_[i].lmd.scenePoint);
    }
    axis_ = leastCovered(lengths, box.upper - box.lower);
    std::sort(order_.begin(), order_.end(), [this](std::uint32_t a, std::uint32_t b) {
      const double sa = start(a), sb = start(b);
      return sa != sb ? sa < sb : comesBefore(minima_[a].lmd, minima_[b].lmd);
    });
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const Minimum& a = minima_[order_[i]];
      // No pair is allowed more than a point at a region's rim.
      const double most = kMergeFactor * closeness_.base + closeness_.gap +
                          (kMergeFactor * kFlatTolerance + kRegionDirection) * a.lmd.distance;
      const double end = Piece(a).high(axis_) + 2.0 * most;
      for (std::size_t j = i + 1; j < order_.size() && start(order_[j]) <= end; ++j)
        join(order_[i], order_[j]);
    }
  }

  std::uint32_t root(std::uint32_t i) const noexcept { return findRoot(parent_, i); }

 private:
  double start(std::uint32_t i) const noexcept { return Piece(minima_[i]).low(axis_); }

  /// The axis that pieces cover with the smallest share of their spread: long edges side by side, as in a
  /// bore, lie apart across their direction.
  static int leastCovered(const glm::dvec3& lengths, const glm::dvec3& spread) noexcept {
    const auto isLess = [&](int a, int b) {
      if (lengths[a] * spread[b] != lengths[b] * spread[a])
        return lengths[a] * spread[b] < lengths[b] * spread[a];
      return spread[a] > spread[b];
    };
    const int first = isLess(1, 0) ? 1 : 0;
    return isLess(2, first) ? 2 : first;
  }

  void join(std::uint32_t i, std::uint32_t j) noexcept {
    Minimum &a = minima_[i], &b = minima_[j];
    const double tolerance = closeness_.of(a, b);
    if (std::abs(b.lmd.distance - a.lmd.distance) > Closeness::ofDistances(a, b, tolerance)) return;
    if (!canTouch(a, b, tolerance)) return;
    const std::uint32_t ra = root(i), rb = root(j);
    const bool overlap = markIfOverlapping(a, b, closeness_.ofOverlap(a.lmd.distance));
    if (ra != rb && (overlap || touch(a, b, tolerance))) parent_[std::max(ra, rb)] = std::min(ra, rb);
  }

  std::span<Minimum> minima_;
  std::span<std::uint32_t> order_, parent_;
  const Closeness closeness_;
  int axis_ = 0;
};

}  // namespace

std::size_t mergeMinima(std::span<Minimum> minima, std::span<std::uint32_t> order,
                        std::span<std::uint32_t> parent, double size, double smallerSize) noexcept {
  const auto count = static_cast<std::uint32_t>(minima.size());
  if (count == 0) return 0;
  const Closeness closeness{kLengthTolerance * size, kFlatGap * smallerSize};
  Grouping grouping(minima, order, parent, closeness);
  grouping.sweep();

  const std::span<std::uint32_t> sorted = order.first(count);
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
    const std::uint32_t ra = grouping.root(a), rb = grouping.root(b);
    return ra != rb ? ra < rb : comesBefore(minima[a].lmd, minima[b].lmd);
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count;) {
    const std::uint32_t first = sorted[i], root = grouping.root(first);
    std::size_t end = i;
    bool isRegion = false;
    for (; end < count && grouping.root(sorted[end]) == root; ++end)
      isRegion = isRegion || minima[sorted[end]].dimension > 0;
    if (isRegion) {
      const double tolerance = closeness.ofOverlap(minima[first].lmd.distance);
      minima[first].lmd = uniteRegion(minima, sorted.subspan(i, end - i), tolerance);
    }
    order[kept++] = first;
    i = end;
  }
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept),
            [&](std::uint32_t a, std::uint32_t b) {
              const double da = minima[a].lmd.distance, db = minima[b].lmd.distance;
              return da != db ? da < db : comesBefore(minima[a].lmd, minima[b].lmd);
            });
  return kept;
}

}  // namespace nearfit
