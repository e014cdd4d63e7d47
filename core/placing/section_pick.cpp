#include "core/placing/section_pick.h"

#include <algorithm>

#include <glm/geometric.hpp>

namespace nearfit {

std::optional<PickedFeature> pickFeature(const MeshSection& section, glm::dvec3& point, double reach,
                                         FeatureFilter filter) {
  if (filter == FeatureFilter::Faces) return std::nullopt;
  const PickedFeature veryPoint{{FeatureShape::Point, point}, {}, {}};
  if (filter == FeatureFilter::Points) return veryPoint;
  PickedFeature edge;
  double nearest = reach;
  for (const auto& [from, to] : section.outline) {
    const glm::dvec3 a = section.points[from], along = section.points[to] - a;
    const double squared = glm::dot(along, along);
    if (!(squared > 0.0)) continue;
    const glm::dvec3 on =
        a + std::clamp(glm::dot(veryPoint.feature.point - a, along) / squared, 0.0, 1.0) * along;
    const double distance = glm::distance(on, veryPoint.feature.point);
    if (!(distance <= nearest)) continue;
    nearest = distance;
    point = on;
    edge.feature = {FeatureShape::Axis, on, glm::normalize(along)};
  }
  if (edge.feature.shape == FeatureShape::Axis) return edge;
  return filter == FeatureFilter::Any ? std::optional(veryPoint) : std::nullopt;
}

}  // namespace nearfit
