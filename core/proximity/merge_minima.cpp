#include "core/proximity/merge_minima.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/aabb.h"
#include "core/math/tolerances.h"

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
  /// Of a sphere about the scene point that holds it.
  double radius() const noexcept { return m_.dimension == 0 ? 0.0 : m_.radius; }

 private:
  const Minimum& m_;
};

bool touch(const Minimum& a, const Minimum& b, double tolerance) noexcept {
  if (a.dimension == 0 && b.dimension == 0) {
    return glm::distance(a.lmd.scenePoint, b.lmd.scenePoint) <= tolerance &&
           glm::distance(a.lmd.partPoint, b.lmd.partPoint) <= tolerance;
  }
  const Piece pa(a), pb(b);
  if (glm::distance(a.lmd.scenePoint, b.lmd.scenePoint) > pa.radius() + pb.radius() + tolerance) return false;
  // Different directions are different minima, even from one point. Coarse: the points decide.
  constexpr double kSameDirection = 1e-6;
  if (glm::dot(a.lmd.direction, b.lmd.direction) < 1.0 - kSameDirection) return false;
  if (pa.contains(b.lmd.scenePoint) || pb.contains(a.lmd.scenePoint)) return true;
  for (std::size_t i = 0; i < pa.sides(); ++i) {
    for (std::size_t j = 0; j < pb.sides(); ++j) {
      if (segmentDistance(pa.from(i), pa.to(i), pb.from(j), pb.to(j)) <= tolerance) return true;
    }
  }
  return false;
}

std::uint32_t findRoot(std::span<std::uint32_t> parent, std::uint32_t i) noexcept {
  while (parent[i] != i)
    i = parent[i] = parent[parent[i]];
  return i;
}

/// Folds `piece` into `root`: the higher dimension wins, equal ones add up by weight, and the largest piece's
/// features stay.
void absorb(Minimum& root, const Minimum& piece) noexcept {
  if (piece.dimension > root.dimension) {
    root = piece;
    return;
  }
  if (piece.dimension < root.dimension || root.dimension == 0) return;
  const double total = root.weight + piece.weight, share = piece.weight / total;
  Lmd merged = piece.weight > root.weight ? piece.lmd : root.lmd;
  merged.scenePoint = glm::mix(root.lmd.scenePoint, piece.lmd.scenePoint, share);
  merged.partPoint = glm::mix(root.lmd.partPoint, piece.lmd.partPoint, share);
  merged.distance = (1.0 - share) * root.lmd.distance + share * piece.lmd.distance;
  root.lmd = merged;
  root.weight = total;
}

}  // namespace

std::size_t mergeMinima(std::span<Minimum> minima, std::span<std::uint32_t> order,
                        std::span<std::uint32_t> parent, double size) noexcept {
  const auto count = static_cast<std::uint32_t>(minima.size());
  if (count == 0) return 0;
  Aabb box;
  for (std::uint32_t i = 0; i < count; ++i) {
    order[i] = parent[i] = i;
    box.add(minima[i].lmd.scenePoint);
  }
  // Sweep along the axis on which they are spread most: what touches overlaps there.
  const glm::dvec3 spread = box.upper - box.lower;
  const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
  const auto start = [&](std::uint32_t i) {
    return minima[i].lmd.scenePoint[axis] - Piece(minima[i]).radius();
  };
  std::sort(order.begin(), order.begin() + count, [&](std::uint32_t a, std::uint32_t b) {
    const double sa = start(a), sb = start(b);
    return sa != sb ? sa < sb : a < b;
  });
  for (std::uint32_t i = 0; i < count; ++i) {
    const Minimum& a = minima[order[i]];
    const double tolerance = kMergeFactor * (kLengthTolerance * size + kAngularTolerance * a.lmd.distance);
    // Across a region that is tilted by no more than the angular tolerance the distance still varies.
    const double window = tolerance + kAngularTolerance * size;
    const double end = a.lmd.scenePoint[axis] + Piece(a).radius() + tolerance;
    for (std::uint32_t j = i + 1; j < count && start(order[j]) <= end; ++j) {
      const Minimum& b = minima[order[j]];
      if (std::abs(b.lmd.distance - a.lmd.distance) > window) continue;
      const std::uint32_t ra = findRoot(parent, order[i]), rb = findRoot(parent, order[j]);
      if (ra != rb && touch(a, b, tolerance)) parent[std::max(ra, rb)] = std::min(ra, rb);
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t root = findRoot(parent, i);
    if (root != i) absorb(minima[root], minima[i]);
  }
  std::size_t kept = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (parent[i] == i) order[kept++] = i;
  }
  const auto isNearer = [&](std::uint32_t a, std::uint32_t b) {
    return minima[a].lmd.distance != minima[b].lmd.distance ? minima[a].lmd.distance < minima[b].lmd.distance
                                                            : a < b;
  };
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), isNearer);
  return kept;
}

}  // namespace nearfit
