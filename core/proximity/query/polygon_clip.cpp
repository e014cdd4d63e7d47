#include "core/proximity/query/polygon_clip.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace nearfit {

bool clipLine(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& normal, const glm::dvec3& start,
              const glm::dvec3& along, double slack, double& from, double& to) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 inward = glm::cross(normal, triangle[(k + 1) % 3] - triangle[k]);
    const double depth = glm::dot(inward, start - triangle[k]) + slack * glm::length(inward);
    const double slope = glm::dot(inward, along);
    // Inside where depth + s * slope >= 0.
    if (slope > 0.0) {
      from = std::max(from, -depth / slope);
    } else if (slope < 0.0) {
      to = std::min(to, -depth / slope);
    } else if (depth < 0.0) {
      return false;
    }
  }
  return from < to;
}

void clipPolygon(const std::array<glm::dvec3, 3>& triangle, const glm::dvec3& normal,
                 ConvexPolygon& polygon) noexcept {
  for (std::size_t k = 0; k < 3 && polygon.count > 0; ++k) {
    const glm::dvec3 inward = glm::cross(normal, triangle[(k + 1) % 3] - triangle[k]);
    const auto depth = [&](const glm::dvec3& p) { return glm::dot(inward, p - triangle[k]); };
    ConvexPolygon kept;
    const auto keep = [&kept](const glm::dvec3& p) {
      // Rounding may cut a corner twice; omitting the extra corner does not change the area.
      if (kept.count < kept.corners.size()) kept.corners[kept.count++] = p;
    };
    for (std::size_t i = 0; i < polygon.count; ++i) {
      const glm::dvec3 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
      const double da = depth(a), db = depth(b);
      if (da >= 0.0) keep(a);
      if ((da >= 0.0) != (db >= 0.0)) keep(a + (da / (da - db)) * (b - a));
    }
    polygon = kept;
  }
}

double polygonArea(const ConvexPolygon& polygon, const glm::dvec3& normal, glm::dvec3& centroid) noexcept {
  if (polygon.count == 0) return 0.0;
  const glm::dvec3& origin = polygon.corners[0];
  double area = 0.0;
  glm::dvec3 moment(0.0);
  for (std::size_t i = 1; i + 1 < polygon.count; ++i) {
    const glm::dvec3 a = polygon.corners[i] - origin, b = polygon.corners[i + 1] - origin;
    const double piece = 0.5 * std::abs(glm::dot(normal, glm::cross(a, b)));
    area += piece;
    moment += piece / 3.0 * (a + b);
  }
  centroid = area > 0.0 ? origin + moment / area : origin;
  return area;
}

}  // namespace nearfit
