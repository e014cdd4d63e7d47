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

/// What the corners span: CGAL's predicates ask for no less.
Shape shapeOf(const TriangleCorners& t) {
  const Point a = toPoint(t[0]), b = toPoint(t[1]), c = toPoint(t[2]);
  if (!CGAL::collinear(a, b, c)) return Kernel::Triangle_3(a, b, c);
  // On a line the least and the greatest by coordinates are the ends.
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

}  // namespace

bool doTrianglesMeet(const TriangleCorners& a, const TriangleCorners& b) {
  return std::visit([](const auto& x, const auto& y) { return doMeet(x, y); }, shapeOf(a), shapeOf(b));
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
