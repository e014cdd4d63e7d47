#include "tests/exact/exact_meeting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <CGAL/Gmpq.h>
#include <glm/geometric.hpp>

#include "core/math/aabb.h"

namespace nearfit::test {
namespace {

using Rational = CGAL::Gmpq;
using Corners = std::array<glm::dvec3, 3>;

struct RationalVector {
  Rational x, y, z;
};
RationalVector difference(const glm::dvec3& a, const glm::dvec3& b) {
  return {Rational(a.x) - Rational(b.x), Rational(a.y) - Rational(b.y), Rational(a.z) - Rational(b.z)};
}
RationalVector operator-(const RationalVector& a, const RationalVector& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Rational dot(const RationalVector& a, const RationalVector& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
RationalVector cross(const RationalVector& a, const RationalVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
bool isZero(const RationalVector& v) {
  return v.x == 0 && v.y == 0 && v.z == 0;
}

bool isZeroOn(const RationalVector& a, const RationalVector& b) {
  return isZero(cross(a, b)) && dot(a, b) <= 0;
}

bool isZeroIn(const RationalVector& a, const RationalVector& b, const RationalVector& c) {
  const RationalVector n = cross(b - a, c - a);
  if (isZero(n) || dot(n, a) != 0) return false;
  return dot(cross(a, b), n) >= 0 && dot(cross(b, c), n) >= 0 && dot(cross(c, a), n) >= 0;
}

bool isZeroIn(const RationalVector& a, const RationalVector& b, const RationalVector& c,
              const RationalVector& d) {
  const Rational volume = dot(cross(b - a, c - a), d - a);
  if (volume == 0) return false;
  // Zero in the place of each corner in turn: no volume turns round.
  const std::array<Rational, 4> parts{dot(cross(b, c), d), -dot(cross(a, c), d), dot(cross(a, b), d),
                                      -dot(cross(a, b), c)};
  for (const Rational& part : parts) {
    if (part * volume < 0) return false;
  }
  return true;
}

bool isBeyond(const std::vector<RationalVector>& points, const RationalVector& axis) {
  int above = 0, below = 0;
  for (const RationalVector& p : points) {
    const Rational height = dot(p, axis);
    above += height > 0 ? 1 : 0;
    below += height < 0 ? 1 : 0;
  }
  const int all = static_cast<int>(points.size());
  return above == all || below == all;
}

RationalVector normalOf(const Corners& t) {
  return cross(difference(t[1], t[0]), difference(t[2], t[0]));
}

Rational squared(const RationalVector& v) {
  return dot(v, v);
}
RationalVector scaled(const Rational& s, const RationalVector& v) {
  return {s * v.x, s * v.y, s * v.z};
}

/// Squared distance of the origin from a segment.
Rational squaredToSegment(const RationalVector& a, const RationalVector& b) {
  const RationalVector along = b - a;
  const Rational length = squared(along), share = -dot(a, along);
  if (share <= 0 || length == 0) return squared(a);
  if (share >= length) return squared(b);
  return squared(a - scaled(-share / length, along));
}

/// Squared distance of the lines of two sides where it is reached inside both; else something greater than
/// that of the triangles, or equal.
Rational squaredOfSides(const RationalVector& w, const RationalVector& u, const RationalVector& v) {
  const RationalVector n = cross(u, v);
  const Rational nn = squared(n);
  if (nn == 0) return squared(w);
  const Rational s = dot(cross(w, v), n) / nn, t = dot(cross(w, u), n) / nn;
  if (s < 0 || s > 1 || t < 0 || t > 1) return squared(w);
  const Rational height = dot(w, n);
  return height * height / nn;
}

/// Squared distance of a point from a face where its foot is inside; else of the point from a corner.
Rational squaredToFace(const glm::dvec3& p, const Corners& t) {
  const RationalVector n = cross(difference(t[1], t[0]), difference(t[2], t[0])), w = difference(p, t[0]);
  for (std::size_t k = 0; k < 3; ++k) {
    if (dot(cross(difference(t[(k + 1) % 3], t[k]), difference(p, t[k])), n) < 0) return squared(w);
  }
  const Rational height = dot(w, n);
  return height * height / squared(n);
}

Aabb boxOf(const Corners& t) {
  Aabb box;
  for (const glm::dvec3& p : t)
    box.add(p);
  return box;
}

Corners placed(const TriangleMesh& mesh, const Triangle& t, const RigidTransform* pose) {
  Corners corners;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 p = mesh.vertices()[t[k]];
    corners[k] = pose == nullptr ? p : pose->applyToPoint(p);
  }
  return corners;
}

/// How far apart the boxes of two triangles are; 0 where they meet.
double gapBetween(const Aabb& a, const Aabb& b) {
  const glm::dvec3 gap = glm::max(glm::max(a.lower - b.upper, b.lower - a.upper), glm::dvec3(0.0));
  return glm::length(gap);
}

/// Calls visit(triangle of the scene, of the part, gap of their boxes) for each pair until it says to stop.
template <class Visit>
void visitPairs(const TriangleMesh& scene, const TriangleMesh& part, const RigidTransform& sceneFromPart,
                Visit&& visit) {
  for (const Triangle& t : part.triangles()) {
    const Corners b = placed(part, t, &sceneFromPart);
    const Aabb box = boxOf(b);
    for (const Triangle& s : scene.triangles()) {
      const Corners a = placed(scene, s, nullptr);
      if (!visit(a, b, gapBetween(boxOf(a), box))) return;
    }
  }
}

}  // namespace

bool doMeetExactly(const Corners& a, const Corners& b) {
  std::vector<RationalVector> d;
  for (const glm::dvec3& p : a) {
    for (const glm::dvec3& q : b)
      d.push_back(difference(p, q));
  }
  // Quick to show that zero is not in their hull, mostly.
  if (isBeyond(d, normalOf(a)) || isBeyond(d, normalOf(b))) return false;
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (isZero(d[i])) return true;
    for (std::size_t j = 0; j < i; ++j) {
      if (isZeroOn(d[i], d[j])) return true;
      for (std::size_t k = 0; k < j; ++k) {
        if (isZeroIn(d[i], d[j], d[k])) return true;
        for (std::size_t l = 0; l < k; ++l) {
          if (isZeroIn(d[i], d[j], d[k], d[l])) return true;
        }
      }
    }
  }
  return false;
}

double exactDistance(const Corners& a, const Corners& b) {
  if (doMeetExactly(a, b)) return 0.0;
  Rational least = squared(difference(a[0], b[0]));
  const auto take = [&](const Rational& n) {
    if (n < least) least = n;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    take(squaredToFace(a[i], b));
    take(squaredToFace(b[i], a));
    const glm::dvec3 a0 = a[i], a1 = a[(i + 1) % 3];
    for (std::size_t j = 0; j < 3; ++j) {
      const glm::dvec3 b0 = b[j], b1 = b[(j + 1) % 3];
      take(squaredToSegment(difference(b0, a0), difference(b1, a0)));
      take(squaredToSegment(difference(a0, b0), difference(a1, b0)));
      take(squaredOfSides(difference(b0, a0), difference(a1, a0), difference(b1, b0)));
    }
  }
  return std::sqrt(CGAL::to_double(least));
}

double leastDistanceExactly(const TriangleMesh& scene, const TriangleMesh& part,
                            const RigidTransform& sceneFromPart) {
  double least = std::numeric_limits<double>::infinity();
  visitPairs(scene, part, sceneFromPart, [&](const Corners& a, const Corners& b, double gap) {
    if (gap < least) least = std::min(least, exactDistance(a, b));
    return true;
  });
  return least;
}

bool doSurfacesMeetExactly(const TriangleMesh& scene, const TriangleMesh& part,
                           const RigidTransform& sceneFromPart) {
  bool doMeet = false;
  visitPairs(scene, part, sceneFromPart, [&](const Corners& a, const Corners& b, double gap) {
    // Boxes that touch may hold triangles that do.
    doMeet = gap == 0.0 && doMeetExactly(a, b);
    return !doMeet;
  });
  return doMeet;
}

double windingNumber(const TriangleMesh& mesh, const glm::dvec3& point) {
  double sum = 0.0;
  for (const Triangle& t : mesh.triangles()) {
    const glm::dvec3 a = mesh.vertices()[t[0]] - point, b = mesh.vertices()[t[1]] - point,
                     c = mesh.vertices()[t[2]] - point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                            la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
  }
  return sum / (4.0 * std::numbers::pi);
}

}  // namespace nearfit::test
