#pragma once

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace nearfit {

/// Point of the segment from a to b nearest to a point; a if the segment has no length. Real-time safe.
inline glm::dvec3 nearestOnSegment(const glm::dvec3& a, const glm::dvec3& b,
                                   const glm::dvec3& point) noexcept {
  const glm::dvec3 along = b - a;
  const double squared = glm::dot(along, along);
  const double share = squared > 0.0 ? std::clamp(glm::dot(point - a, along) / squared, 0.0, 1.0) : 0.0;
  return a + share * along;
}

}  // namespace nearfit
