#include "core/math/extreme_directions.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/axes_across.h"

namespace nearfit {
namespace {

/// Point where a direction pierces the plane at distance 1 along the axis, and the direction's index.
struct Pierced {
  double x, y;
  std::size_t index;
};

std::vector<Pierced> pierce(std::span<const glm::dvec3> directions, const glm::dvec3& axis) {
  const auto [u, v] = axesAcross(axis);
  std::vector<Pierced> points;
  points.reserve(directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double depth = glm::dot(directions[i], axis);
    points.push_back({glm::dot(directions[i], u) / depth, glm::dot(directions[i], v) / depth, i});
  }
  return points;
}

bool turnsLeft(const Pierced& a, const Pierced& b, const Pierced& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 0.0;
}

}  // namespace

std::vector<std::size_t> extremeDirections(std::span<const glm::dvec3> directions, const glm::dvec3& axis) {
  std::vector<Pierced> points = pierce(directions, axis);
  if (points.empty()) return {};
  if (points.size() == 1) return {points[0].index};
  std::sort(points.begin(), points.end(), [](const Pierced& a, const Pierced& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.index < b.index;
  });
  std::vector<Pierced> hull;
  const auto chain = [&](const auto& first, const auto& last) {
    const std::size_t base = hull.size();
    for (auto it = first; it != last; ++it) {
      while (hull.size() >= base + 2 && !turnsLeft(hull[hull.size() - 2], hull.back(), *it))
        hull.pop_back();
      hull.push_back(*it);
    }
    hull.pop_back();
  };
  chain(points.begin(), points.end());
  chain(points.rbegin(), points.rend());
  std::vector<std::size_t> indices;
  indices.reserve(hull.size());
  for (const Pierced& p : hull)
    indices.push_back(p.index);
  return indices;
}

}  // namespace nearfit
