#include "core/placing/screen_shapes.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

double distanceToSegment(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& point) noexcept {
  const glm::dvec2 way = b - a;
  const double lengthSquared = glm::dot(way, way);
  const double share =
      lengthSquared > 0.0 ? std::clamp(glm::dot(point - a, way) / lengthSquared, 0.0, 1.0) : 0.0;
  return glm::distance(point, a + share * way);
}

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) noexcept {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

double distanceToLine(std::span<const glm::dvec2> line, const glm::dvec2& point) noexcept {
  if (line.empty()) return std::numeric_limits<double>::infinity();
  double least = glm::distance(line[0], point);
  for (std::size_t i = 1; i < line.size(); ++i)
    least = std::min(least, distanceToSegment(line[i - 1], line[i], point));
  return least;
}

bool isInside(std::span<const glm::dvec2> polygon, const glm::dvec2& point) noexcept {
  bool inside = false;
  for (std::size_t i = 0, last = polygon.size() - 1; i < polygon.size(); last = i++) {
    const glm::dvec2 &a = polygon[i], &b = polygon[last];
    if ((a.y > point.y) == (b.y > point.y)) continue;
    if (point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y)) inside = !inside;
  }
  return inside;
}

std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points) {
  if (points.size() < 3) return points;
  std::ranges::sort(points, [](const glm::dvec2& a, const glm::dvec2& b) {
    return std::pair(a.x, a.y) < std::pair(b.x, b.y);
  });
  std::vector<glm::dvec2> hull;
  const auto add = [&hull](const glm::dvec2& point, std::size_t least) {
    while (hull.size() >= least + 2 && !(turn(hull[hull.size() - 2], hull.back(), point) > 0.0))
      hull.pop_back();
    hull.push_back(point);
  };
  // Along one side, then back along the other.
  for (const glm::dvec2& point : points)
    add(point, 0);
  const std::size_t turned = hull.size() - 1;
  for (auto it = points.rbegin() + 1; it != points.rend(); ++it)
    add(*it, turned);
  hull.pop_back();
  return hull;
}

}  // namespace nearfit
