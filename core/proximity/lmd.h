#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

namespace nearfit {

enum class FeatureKind : std::uint8_t { Vertex, Edge, Face };

/// A local minimum distance: no small move of either point along its surface shortens the segment between
/// them. Points are in the frame that the query states; `partPoint - scenePoint` points out of the scene.
struct Lmd {
  glm::dvec3 scenePoint{0.0};  ///< [m]
  glm::dvec3 partPoint{0.0};   ///< [m]
  double distance = 0.0;       ///< |partPoint - scenePoint| > 0 [m].
  glm::dvec3 direction{
      0.0};  ///< Unit, from the scene point to the part point; well defined however near they are.
  std::uint32_t sceneIndex = 0;  ///< Vertex, edge or face of the scene mesh that carries scenePoint.
  std::uint32_t partIndex = 0;   ///< Vertex, edge or face of the part mesh that carries partPoint.
  FeatureKind sceneFeature = FeatureKind::Vertex;
  FeatureKind partFeature = FeatureKind::Vertex;
  /// One representative of a connected flat set of equal minima (parallel faces or edges): its centroid.
  bool isRegion = false;
  /// The segment passes through a surface on its way, so that nothing can move along it: set by markBlocked
  /// alone. No force comes of such a minimum.
  bool isBlocked = false;
};

}  // namespace nearfit
