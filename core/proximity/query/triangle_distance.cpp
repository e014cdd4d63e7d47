#include "core/proximity/query/triangle_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

void take(const ClosestPoints& other, ClosestPoints& best) noexcept {
  if (other.distanceSquared < best.distanceSquared) best = other;
}

double squaredDistance(const glm::dvec3& a, const glm::dvec3& b) noexcept {
  return glm::dot(b - a, b - a);
}

template <class Two>
Two least(Two a, Two b) noexcept {
  return a < b ? a : b;
}
template <class Two>
Two most(Two a, Two b) noexcept {
  return a > b ? a : b;
}

/// A triangle, to be tested against the face of another.
struct Against {
  const TriangleCorners& corners;
  const TriangleFrame& frame;  ///< Frame of the other.
};

/// Closest points of a corner over the other's face, or the point where a side passes through the face.
ClosestPoints closestToFace(const Against& t) noexcept {
  ClosestPoints best{{}, {}, std::numeric_limits<double>::infinity()};
  std::array<TriangleFrame::Coordinates, 3> at;
  for (std::size_t k = 0; k < 3; ++k) {
    at[k] = t.frame.of(t.corners[k]);
    if (!t.frame.holds(at[k].x, at[k].y)) continue;
    take({t.corners[k], t.corners[k] - at[k].z * t.frame.normal(), at[k].z * at[k].z}, best);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const auto &p = at[k], &q = at[(k + 1) % 3];
    if (!(p.z * q.z < 0.0)) continue;
    const double share = p.z / (p.z - q.z);
    if (!t.frame.holds(p.x + share * (q.x - p.x), p.y + share * (q.y - p.y))) continue;
    const glm::dvec3 through = t.corners[k] + share * (t.corners[(k + 1) % 3] - t.corners[k]);
    take({through, through, 0.0}, best);
  }
  return best;
}

/// triangleGapLowerBound, with `squaredGap(own, other)` the squared gap along own's directions.
template <class Of, class T>
double gapBy(Of squaredGap, const T& a, const T& b, double enough, bool& isSecond) noexcept {
  const double first = isSecond ? squaredGap(b, a) : squaredGap(a, b);
  if (first > enough * enough) return std::sqrt(first);
  const double other = isSecond ? squaredGap(a, b) : squaredGap(b, a);
  if (other > first) isSecond = !isSecond;
  return std::sqrt(std::max(first, other));
}

}  // namespace

ClosestPoints closestOfSegments(const glm::dvec3& a0, const glm::dvec3& a1, const glm::dvec3& b0,
                                const glm::dvec3& b1) noexcept {
  const glm::dvec3 u = a1 - a0, v = b1 - b0, w = b0 - a0, normal = glm::cross(u, v);
  const double uu = glm::dot(u, u), vv = glm::dot(v, v), nn = glm::dot(normal, normal);
  const auto shareOfA = [&](const glm::dvec3& p) {
    return uu > 0.0 ? std::clamp(glm::dot(p - a0, u) / uu, 0.0, 1.0) : 0.0;
  };
  const auto shareOfB = [&](const glm::dvec3& p) {
    return vv > 0.0 ? std::clamp(glm::dot(p - b0, v) / vv, 0.0, 1.0) : 0.0;
  };
  // The cross product of the directions tells a small angle better than a difference of squares.
  const double start = nn > 0.0 ? std::clamp(glm::dot(glm::cross(w, v), normal) / nn, 0.0, 1.0) : 0.0;
  const glm::dvec3 q = b0 + shareOfB(a0 + start * u) * v;
  const glm::dvec3 p = a0 + shareOfA(q) * u;
  ClosestPoints best{p, q, squaredDistance(p, q)};
  if (nn > kParallelSegments * uu * vv) return best;
  for (const glm::dvec3& end : {a0, a1}) {
    const glm::dvec3 other = b0 + shareOfB(end) * v;
    take({end, other, squaredDistance(end, other)}, best);
  }
  for (const glm::dvec3& end : {b0, b1}) {
    const glm::dvec3 other = a0 + shareOfA(end) * u;
    take({other, end, squaredDistance(other, end)}, best);
  }
  return best;
}

TriangleFrame::TriangleFrame(const TriangleCorners& corners) noexcept {
  std::size_t longest = 0;
  double squared = -1.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double s = squaredDistance(corners[k], corners[(k + 1) % 3]);
    if (s > squared) {
      longest = k;
      squared = s;
    }
  }
  origin_ = corners[longest];
  length_ = std::sqrt(squared);
  u_ = (corners[(longest + 1) % 3] - origin_) / length_;
  const glm::dvec3 third = corners[(longest + 2) % 3] - origin_;
  apex_ = glm::dot(third, u_);
  const glm::dvec3 across = third - apex_ * u_;
  height_ = glm::length(across);
  n_ = glm::normalize(glm::cross(u_, across));
  t_ = glm::cross(n_, u_);
}

TriangleFrame::Coordinates TriangleFrame::of(const glm::dvec3& point) const noexcept {
  const glm::dvec3 w = point - origin_;
  const double x = glm::dot(w, u_);
  const glm::dvec3 square = w - x * u_;
  return {x, glm::dot(square, t_), glm::dot(square, n_)};
}

bool TriangleFrame::holds(double x, double y, double slack) const noexcept {
  const double beyond = slack * length_, up = y / height_;
  return y >= -beyond && y <= height_ + beyond && x >= apex_ * up - beyond &&
         x <= length_ + (apex_ - length_) * up + beyond;
}

ClosestPoints closestOfTriangles(const TriangleCorners& a, const TriangleCorners& b) noexcept {
  ClosestPoints best{{}, {}, std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      take(closestOfSegments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]), best);
  }
  const TriangleFrame frameA(a), frameB(b);
  take(closestToFace({a, frameB}), best);
  const ClosestPoints turned = closestToFace({b, frameA});
  take({turned.b, turned.a, turned.distanceSquared}, best);
  return best;
}

SeparatingDirections::Pair SeparatingDirections::pairOf(const glm::dvec3& a, const glm::dvec3& b,
                                                        const glm::dvec3& u, const glm::dvec3& v) noexcept {
  Pair pair{{a.x, b.x}, {a.y, b.y}, {a.z, b.z}, {}, {}, {}};
  const auto at = [&](const glm::dvec3& p) { return pair.x * p.x + pair.y * p.y + pair.z * p.z; };
  const Two zero{}, atU = at(u), atV = at(v);
  pair.lengthSquared = pair.x * pair.x + pair.y * pair.y + pair.z * pair.z;
  pair.low = least(zero, least(atU, atV));
  pair.high = most(zero, most(atU, atV));
  return pair;
}

SeparatingDirections::SeparatingDirections(const TriangleCorners& corners) noexcept : origin_(corners[0]) {
  const glm::dvec3 u = corners[1] - corners[0], v = corners[2] - corners[0], n = glm::cross(u, v);
  first_ = pairOf(n, glm::cross(u, n), u, v);
  second_ = pairOf(glm::cross(v, n), glm::cross(v - u, n), u, v);
}

double SeparatingDirections::squaredGap(const Pair& pair, const TriangleCorners& relative) noexcept {
  const auto at = [&](const glm::dvec3& p) { return pair.x * p.x + pair.y * p.y + pair.z * p.z; };
  const Two zero{}, q0 = at(relative[0]), q1 = at(relative[1]), q2 = at(relative[2]);
  const Two above = least(q0, least(q1, q2)) - pair.high;
  const Two below = pair.low - most(q0, most(q1, q2));
  const Two gap = most(zero, most(above, below)), squared = gap * gap;
  // A direction without length has no gap.
  const double first = squared[0] > 0.0 ? squared[0] / pair.lengthSquared[0] : 0.0;
  return squared[1] > first * pair.lengthSquared[1] ? squared[1] / pair.lengthSquared[1] : first;
}

double SeparatingDirections::squaredGap(const TriangleCorners& other) const noexcept {
  const TriangleCorners relative{other[0] - origin_, other[1] - origin_, other[2] - origin_};
  return std::max(squaredGap(first_, relative), squaredGap(second_, relative));
}

glm::dvec3 SeparatingDirections::directionOfGap(const TriangleCorners& other) const noexcept {
  glm::dvec3 best(0.0);
  double most = 0.0;
  for (const Pair& pair : {first_, second_}) {
    for (std::size_t k = 0; k < 2; ++k) {
      const glm::dvec3 d(pair.x[k], pair.y[k], pair.z[k]);
      const double length = std::sqrt(pair.lengthSquared[k]);
      if (!(length > 0.0)) continue;
      const auto at = [&](const glm::dvec3& p) { return glm::dot(d, p - origin_); };
      const double q0 = at(other[0]), q1 = at(other[1]), q2 = at(other[2]);
      const double above = (std::min(q0, std::min(q1, q2)) - pair.high[k]) / length,
                   below = (pair.low[k] - std::max(q0, std::max(q1, q2))) / length;
      if (std::max(above, below) > most) {
        most = std::max(above, below);
        best = (above > below ? d : -d) / length;
      }
    }
  }
  return best;
}

double triangleGapLowerBound(const DirectedTriangle& a, const DirectedTriangle& b, double enough,
                             bool& isSecond) noexcept {
  return gapBy([](const DirectedTriangle& own,
                  const DirectedTriangle& other) { return own.directions.squaredGap(other.corners); },
               a, b, enough, isSecond);
}

double triangleGapLowerBound(const TriangleCorners& a, const TriangleCorners& b, double enough,
                             bool& isSecond) noexcept {
  // The second triangle's directions are seldom needed.
  return gapBy([](const TriangleCorners& own,
                  const TriangleCorners& other) { return SeparatingDirections(own).squaredGap(other); },
               a, b, enough, isSecond);
}

glm::dvec3 directionOfGap(const DirectedTriangle& a, const DirectedTriangle& b, bool isSecond) noexcept {
  return isSecond ? -b.directions.directionOfGap(a.corners) : a.directions.directionOfGap(b.corners);
}

glm::dvec3 directionOfGap(const TriangleCorners& a, const TriangleCorners& b, bool isSecond) noexcept {
  return isSecond ? -SeparatingDirections(b).directionOfGap(a) : SeparatingDirections(a).directionOfGap(b);
}

}  // namespace nearfit
