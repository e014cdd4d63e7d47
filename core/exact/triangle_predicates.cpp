#include "core/exact/triangle_predicates.h"

#include <algorithm>
#include <array>
#include <variant>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/intersections.h>

namespace nearfit {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Shape = std::variant<Point, Kernel::Segment_3, Kernel::Triangle_3>;

Point toPoint(const glm::dvec3& p) {
  return {p.x, p.y, p.z};
}

/// The point, segment or triangle that the corners span; CGAL's predicates reject degenerate shapes.
Shape shapeOf(const TriangleCorners& t) {
  const Point a = toPoint(t[0]), b = toPoint(t[1]), c = toPoint(t[2]);
  if (!CGAL::collinear(a, b, c)) return Kernel::Triangle_3(a, b, c);
  // Of collinear points, the lexicographic min and max are the ends.
  const auto [low, high] = std::minmax(
      {a, b, c}, [](const Point& x, const Point& y) { return CGAL::compare_xyz(x, y) == CGAL::SMALLER; });
  if (low == high) return low;
  return Kernel::Segment_3(low, high);
}

template <class A, class B>
bool doMeet(const A& a, const B& b) {
  return CGAL::do_intersect(a, b);
}
bool doMeet(const Point& a, const Point& b) {
  return a == b;
}

/// True if a plane through the shared corner (the first of each) and the other corners of `a` has the rest
/// of `b` strictly on one side. For coplanar triangles: true if a side of `a` at that corner has `b`
/// strictly behind it.
bool isBeside(const TriangleCorners& a, const TriangleCorners& b) {
  const Point o = toPoint(a[0]), a1 = toPoint(a[1]), a2 = toPoint(a[2]), b1 = toPoint(b[1]),
              b2 = toPoint(b[2]);
  const CGAL::Orientation first = CGAL::orientation(o, a1, a2, b1), second = CGAL::orientation(o, a1, a2, b2);
  if (first != CGAL::COPLANAR || second != CGAL::COPLANAR) return first != CGAL::COPLANAR && first == second;
  if (CGAL::collinear(o, a1, a2)) return false;
  const auto isBehind = [&](const Point& end, const Point& within) {
    return CGAL::coplanar_orientation(o, end, within, b1) == CGAL::NEGATIVE &&
           CGAL::coplanar_orientation(o, end, within, b2) == CGAL::NEGATIVE;
  };
  return isBehind(a1, a2) || isBehind(a2, a1);
}

/// The intersection is convex, so it reaches from the corner to the far side of one of the triangles.
bool doMeetBeyondCorner(const TriangleCorners& a, const TriangleCorners& b) {
  if (isBeside(a, b) || isBeside(b, a)) return false;
  return doTrianglesMeet({a[1], a[2], a[2]}, b) || doTrianglesMeet({b[1], b[2], b[2]}, a);
}

/// Triangles with a common side meet elsewhere only if they are folded flat onto each other.
bool doMeetBeyondSide(const TriangleCorners& a, const TriangleCorners& b) {
  if (CGAL::orientation(toPoint(a[0]), toPoint(a[1]), toPoint(a[2]), toPoint(b[2])) != CGAL::COPLANAR)
    return false;
  const auto doSegmentsMeet = [](const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& r,
                                 const glm::dvec3& s) { return doTrianglesMeet({p, q, q}, {r, s, s}); };
  return doTrianglesMeet({a[2], a[2], a[2]}, b) || doTrianglesMeet({b[2], b[2], b[2]}, a) ||
         doSegmentsMeet(a[0], a[2], b[1], b[2]) || doSegmentsMeet(a[1], a[2], b[0], b[2]);
}

}  // namespace

bool doTrianglesMeet(const TriangleCorners& a, const TriangleCorners& b) {
  return std::visit([](const auto& x, const auto& y) { return doMeet(x, y); }, shapeOf(a), shapeOf(b));
}

bool doTrianglesMeetBeyond(const TriangleCorners& a, const TriangleCorners& b, std::size_t shared) {
  switch (shared) {
    case 0:
      return doTrianglesMeet(a, b);
    case 1:
      return doMeetBeyondCorner(a, b);
    case 2:
      return doMeetBeyondSide(a, b);
    default:
      return true;
  }
}

int sideOf(const glm::dvec3& point, const TriangleCorners& triangle) {
  return static_cast<int>(
      CGAL::orientation(toPoint(triangle[0]), toPoint(triangle[1]), toPoint(triangle[2]), toPoint(point)));
}

bool hasNoArea(const TriangleCorners& triangle) {
  return CGAL::collinear(toPoint(triangle[0]), toPoint(triangle[1]), toPoint(triangle[2]));
}

Crossing crossingOf(const glm::dvec3& from, const glm::dvec3& to, const TriangleCorners& triangle) {
  const Point p = toPoint(from), q = toPoint(to), a = toPoint(triangle[0]), b = toPoint(triangle[1]),
              c = toPoint(triangle[2]);
  const CGAL::Orientation start = CGAL::orientation(a, b, c, p), end = CGAL::orientation(a, b, c, q);
  if (start == CGAL::COPLANAR || end == CGAL::COPLANAR || start == end) return Crossing::None;
  const std::array<CGAL::Orientation, 3> sides{CGAL::orientation(p, q, a, b), CGAL::orientation(p, q, b, c),
                                               CGAL::orientation(p, q, c, a)};
  const bool isLeft = std::ranges::count(sides, CGAL::POSITIVE) > 0;
  const bool isRight = std::ranges::count(sides, CGAL::NEGATIVE) > 0;
  if (isLeft && isRight) return Crossing::None;
  if (std::ranges::count(sides, CGAL::COPLANAR) > 0) return Crossing::Unclear;
  return end == CGAL::POSITIVE ? Crossing::Out : Crossing::In;
}

}  // namespace nearfit
