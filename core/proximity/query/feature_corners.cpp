#include "core/proximity/query/feature_corners.h"

#include <limits>

#include "core/math/nearest_on_segment.h"
#include "core/proximity/query/triangle_distance.h"

namespace nearfit {
namespace {

/// Nearest point of a triangle.
glm::dvec3 nearestOnTriangle(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& point) noexcept {
  const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  glm::dvec3 nearest = corners[0];
  double least = std::numeric_limits<double>::infinity();
  bool isInside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &a = corners[k], &b = corners[(k + 1) % 3];
    if (glm::dot(glm::cross(normal, b - a), point - a) >= 0.0) continue;
    isInside = false;
    const glm::dvec3 at = nearestOnSegment(a, b, point), apart = point - at;
    const double squared = glm::dot(apart, apart);
    if (squared < least) {
      least = squared;
      nearest = at;
    }
  }
  const double squared = glm::dot(normal, normal);
  if (!isInside || !(squared > 0.0)) return nearest;
  return point - glm::dot(point - corners[0], normal) / squared * normal;
}

}  // namespace

FeatureCorners cornersOf(const NormalConeTree& tree, std::uint32_t leaf) noexcept {
  const std::uint32_t i = NormalConeTree::leafIndex(leaf);
  const std::span<const glm::dvec3> at = tree.positions();
  switch (NormalConeTree::leafKind(leaf)) {
    case FeatureKind::Vertex: {
      const glm::dvec3& v = at[tree.vertices()[i].vertex];
      return {{v, v, v}, 1};
    }
    case FeatureKind::Edge: {
      const NormalConeTree::EdgeLeaf& edge = tree.edges()[i];
      return {{at[edge.v0], at[edge.v1], at[edge.v1]}, 2};
    }
    case FeatureKind::Face:
      break;
  }
  const Triangle& corners = tree.faces()[i].corners;
  return {{at[corners[0]], at[corners[1]], at[corners[2]]}, 3};
}

FeatureCorners placed(const FeatureCorners& corners, const glm::dmat3& turn,
                      const glm::dvec3& shift) noexcept {
  FeatureCorners out = corners;
  for (std::size_t k = 0; k < corners.count; ++k)
    out.at[k] = turn * corners.at[k] + shift;
  for (std::size_t k = corners.count; k < out.at.size(); ++k)
    out.at[k] = out.at[k - 1];
  return out;
}

glm::dvec3 directionAcross(const FeatureCorners& scene, const FeatureCorners& part) noexcept {
  const auto normal = [](const FeatureCorners& face) {
    return glm::cross(face.at[1] - face.at[0], face.at[2] - face.at[0]);
  };
  if (scene.count == 3) return normal(scene);
  if (part.count == 3) return normal(part);
  if (scene.count == 2 && part.count == 2)
    return glm::cross(scene.at[1] - scene.at[0], part.at[1] - part.at[0]);
  return glm::dvec3(0.0);
}

glm::dvec3 betweenNearest(const FeatureCorners& scene, const FeatureCorners& part) noexcept {
  if (scene.count == 3) return part.at[0] - nearestOnTriangle(scene.at, part.at[0]);
  if (part.count == 3) return nearestOnTriangle(part.at, scene.at[0]) - scene.at[0];
  const ClosestPoints found = closestOfSegments(scene.at[0], scene.at[1], part.at[0], part.at[1]);
  return found.b - found.a;
}

}  // namespace nearfit
