#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {

/// Roundings of a coordinate in how far two features are apart along a direction, poses and features counted.
constexpr double kSeparationRoundings = 32.0;

/// Corners of a feature; unused ones repeat the last.
struct FeatureCorners {
  std::array<glm::dvec3, 3> at;
  std::size_t count;
};

/// Returns a feature's corners in the tree's centred frame. Real-time safe.
FeatureCorners cornersOf(const NormalConeTree& tree, std::uint32_t leaf) noexcept;

/// Returns corners moved into another frame.
FeatureCorners placed(const FeatureCorners& corners, const glm::dmat3& turn,
                      const glm::dvec3& shift) noexcept;

/// Extent of a feature along a direction.
struct FeatureExtent {
  double low, high;
};
inline FeatureExtent extentAlong(const glm::dvec3& direction, const FeatureCorners& corners) noexcept {
  const double a = glm::dot(direction, corners.at[0]), b = glm::dot(direction, corners.at[1]),
               c = glm::dot(direction, corners.at[2]);
  return {a < b ? (a < c ? a : c) : (b < c ? b : c), a > b ? (a > c ? a : c) : (b > c ? b : c)};
}

/// Returns a direction, of any length, that separates two features in one frame without a search: a face's
/// normal, or what is perpendicular to both edges; zero for other pairs, and for parallel edges.
glm::dvec3 directionAcross(const FeatureCorners& scene, const FeatureCorners& part) noexcept;

/// Returns the vector from the nearest point of the scene's feature to that of the part's, for two features
/// that span a contact (spansContact()), in one frame [m]. Of a face and a vertex it leads to the vertex or from it.
glm::dvec3 betweenNearest(const FeatureCorners& scene, const FeatureCorners& part) noexcept;

}  // namespace nearfit
