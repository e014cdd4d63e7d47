#include "core/proximity/query/touching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"

namespace nearfit {
namespace {

/// Multiple of a tolerance at which rounding no longer decides.
constexpr double kBeyond = 2.0;

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

/// Entry as a convex set in a plane. Two sets are as far apart as their outlines, or not at all if one holds
/// a corner of the other.
class Piece {
 public:
  explicit Piece(const Minimum& m) : m_(m) {}

  std::size_t corners() const noexcept { return m_.dimension == 0 ? 1 : m_.cornerCount; }
  std::size_t sides() const noexcept { return m_.dimension == 2 ? m_.cornerCount : 1; }
  const glm::dvec3& from(std::size_t i) const noexcept {
    return m_.dimension == 0 ? m_.lmd.scenePoint : m_.corners[i];
  }
  const glm::dvec3& to(std::size_t i) const noexcept {
    return m_.dimension == 0 ? m_.lmd.scenePoint : m_.corners[i + 1 < m_.cornerCount ? i + 1 : 0];
  }
  bool contains(const glm::dvec3& p) const noexcept {
    if (m_.dimension != 2) return false;
    bool left = true, right = true;
    for (std::size_t i = 0; i < m_.cornerCount && (left || right); ++i) {
      const double turn = glm::dot(glm::cross(to(i) - from(i), p - from(i)), m_.lmd.direction);
      left = left && turn >= 0.0;
      right = right && turn <= 0.0;
    }
    return left || right;
  }

 private:
  const Minimum& m_;
};

/// Radius of a sphere about the scene point that holds the entry [m].
double radius(const Minimum& m) noexcept {
  return m.dimension == 0 ? 0.0 : m.radius;
}

/// Tolerance between distances of minima that may be one [m]: they differ over a region that is not flat.
double toleranceOfDistances(const Minimum& a, const Minimum& b, double lengths) noexcept {
  return lengths + 2.0 * kFlatTolerance * (radius(a) + radius(b));
}

/// Most pieces that touch have a common corner; this is found sooner than close sides.
bool haveCommonCorner(const Piece& a, const Piece& b, double tolerance) noexcept {
  for (std::size_t i = 0; i < a.corners(); ++i) {
    for (std::size_t j = 0; j < b.corners(); ++j) {
      const glm::dvec3 apart = a.from(i) - b.from(j);
      if (glm::dot(apart, apart) <= tolerance * tolerance) return true;
    }
  }
  return false;
}

/// True if a line beside one of a's sides, more than the tolerance away, has b on its other side: found
/// sooner than that no two sides are near.
bool isBeyondSide(const Minimum& a, const Piece& pa, const Piece& pb, double tolerance) noexcept {
  if (a.dimension != 2) return false;
  for (std::size_t i = 0; i < pa.sides(); ++i) {
    glm::dvec3 inward = glm::cross(a.lmd.direction, pa.to(i) - pa.from(i));
    if (glm::dot(inward, a.lmd.scenePoint - pa.from(i)) < 0.0) inward = -inward;
    const double limit = -tolerance * glm::length(inward);
    bool isBeyond = true;
    for (std::size_t k = 0; k < pb.corners() && isBeyond; ++k)
      isBeyond = glm::dot(inward, pb.from(k) - pa.from(i)) < limit;
    if (isBeyond) return true;
  }
  return false;
}

/// True if the line along a side of `a` has all corners of `b` on its other side.
bool isBeyondSide(const SidedPiece& a, std::size_t side, const Minimum& b, double tolerance) noexcept {
  const glm::dvec3 &from = a.piece.corners[side], &inward = a.sides.inward[side];
  for (std::size_t k = 0; k < b.cornerCount; ++k) {
    if (!(glm::dot(inward, b.corners[k] - from) <= tolerance)) return false;
  }
  return true;
}

bool isApartAlongSide(const SidedPiece& a, const Minimum& b, double tolerance) noexcept {
  // The side beyond which b's centroid lies farthest most likely has all of b beyond it. It is tried first,
  // since each failed try is an unpredictable branch.
  std::size_t first = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < a.piece.cornerCount; ++i) {
    const double height = glm::dot(a.sides.inward[i], b.lmd.scenePoint - a.piece.corners[i]);
    const bool isLess = a.sides.length[i] > tolerance && height < least;
    first = isLess ? i : first;
    least = isLess ? height : least;
  }
  // If the centroid is well inside every side, each side has a corner of b inside it.
  if (least > kBeyond * tolerance) return false;
  if (isBeyondSide(a, first, b, tolerance)) return true;
  for (std::size_t i = 0; i < a.piece.cornerCount; ++i) {
    if (a.sides.length[i] > tolerance && isBeyondSide(a, i, b, tolerance)) return true;
  }
  return false;
}

bool segmentsOverlap(const Minimum& a, const Minimum& b, double tolerance) noexcept {
  const glm::dvec3 along = (a.corners[1] - a.corners[0]) / a.weight;
  std::array<double, 2> s;
  for (std::size_t k = 0; k < 2; ++k) {
    const glm::dvec3 w = b.corners[k] - a.corners[0];
    s[k] = glm::dot(w, along);
    if (glm::distance(w, s[k] * along) > tolerance) return false;
  }
  return std::min(a.weight, std::max(s[0], s[1])) - std::max(0.0, std::min(s[0], s[1])) > tolerance;
}

}  // namespace

TouchTolerances::TouchTolerances(double size, double smallerSize) noexcept
    : base_(kLengthTolerance * size), gap_(kFlatGap * smallerSize) {}

double TouchTolerances::of(const Minimum& a, const Minimum& b) const noexcept {
  const double distance = std::max(a.lmd.distance, b.lmd.distance);
  if (a.dimension == 0 && b.dimension == 0) return kMergeFactor * (base_ + kAngularTolerance * distance);
  const double turn = kMergeFactor * kFlatTolerance + glm::distance(a.lmd.direction, b.lmd.direction);
  return kMergeFactor * base_ + gap_ + turn * distance;
}

double TouchTolerances::ofOverlap(double distance) const noexcept {
  return kMergeFactor * (base_ + kFlatTolerance * distance);
}

double TouchTolerances::margin(const Minimum& m) const noexcept {
  // No pair has a larger tolerance than a point at a region's rim. Seen along their directions, pieces whose
  // directions differ may overlap beside each other.
  const double turn = kMergeFactor * kFlatTolerance + kRegionDirection;
  return kMergeFactor * base_ + gap_ + turn * (m.lmd.distance + radius(m));
}

bool canTouch(const Minimum& a, const Minimum& b, const TouchTolerances& closeness) noexcept {
  const double tolerance = closeness.of(a, b);
  if (std::abs(b.lmd.distance - a.lmd.distance) > toleranceOfDistances(a, b, tolerance)) return false;
  if (a.dimension == 0 && b.dimension == 0) return true;
  if (glm::distance(a.lmd.direction, b.lmd.direction) > kRegionDirection) return false;
  const double radii = radius(a) + radius(b), reach = radii + tolerance;
  const glm::dvec3 apart = a.lmd.scenePoint - b.lmd.scenePoint;
  if (glm::dot(apart, apart) > reach * reach) return false;
  // Two steps of the scene may face two steps of the part at one distance: two regions, one behind the other.
  const glm::dvec3& across = a.dimension > b.dimension ? a.lmd.direction : b.lmd.direction;
  return std::abs(glm::dot(apart, across)) <= tolerance + 2.0 * kFlatTolerance * radii;
}

bool touch(const Minimum& a, const Minimum& b, const TouchTolerances& closeness) noexcept {
  const double tolerance = closeness.of(a, b);
  if (a.dimension == 0 && b.dimension == 0) {
    return glm::distance(a.lmd.scenePoint, b.lmd.scenePoint) <= tolerance &&
           glm::distance(a.lmd.partPoint, b.lmd.partPoint) <= tolerance;
  }
  const Piece pa(a), pb(b);
  if (haveCommonCorner(pa, pb, tolerance)) return true;
  if (isBeyondSide(a, pa, pb, kBeyond * tolerance) || isBeyondSide(b, pb, pa, kBeyond * tolerance))
    return false;
  if (pa.contains(b.lmd.scenePoint) || pb.contains(a.lmd.scenePoint)) return true;
  for (std::size_t i = 0; i < pa.sides(); ++i) {
    for (std::size_t j = 0; j < pb.sides(); ++j) {
      if (segmentDistance(pa.from(i), pa.to(i), pb.from(j), pb.to(j)) <= tolerance) return true;
    }
  }
  return false;
}

void findSides(const Minimum& piece, PieceSides& sides) noexcept {
  if (piece.dimension != 2) return;
  for (std::size_t i = 0; i < piece.cornerCount; ++i) {
    const glm::dvec3& from = piece.corners[i];
    const glm::dvec3& to = piece.corners[i + 1 < piece.cornerCount ? i + 1 : 0];
    const glm::dvec3 inward = glm::cross(piece.lmd.direction, to - from);
    const double length = glm::length(inward);
    sides.length[i] = length;
    sides.inward[i] = glm::dvec3(0.0);
    if (!(length > 0.0)) continue;
    sides.inward[i] = inward * ((glm::dot(inward, piece.lmd.scenePoint - from) < 0.0 ? -1.0 : 1.0) / length);
  }
}

bool overlap(const SidedPiece& a, const SidedPiece& b, double tolerance) noexcept {
  if (a.piece.dimension != b.piece.dimension || a.piece.dimension == 0) return false;
  if (a.piece.dimension == 1) return segmentsOverlap(a.piece, b.piece, tolerance);
  return !isApartAlongSide(a, b.piece, tolerance) && !isApartAlongSide(b, a.piece, tolerance);
}

Aabb boxOf(const Minimum& m, double margin) noexcept {
  Aabb box;
  if (m.dimension == 0) box.add(m.lmd.scenePoint);
  for (std::size_t i = 0; m.dimension != 0 && i < m.cornerCount; ++i)
    box.add(m.corners[i]);
  box.lower -= margin;
  box.upper += margin;
  return box;
}

}  // namespace nearfit
