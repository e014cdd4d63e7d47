#pragma once

#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit {

enum class FeatureKind : std::uint8_t { Vertex, Edge, Face };

/// How far a flat region reaches, seen along its direction. Two axes: `axis`, its long one, and
/// direction x axis.
struct RegionExtent {
  double measure = 0.0;     ///< Length of a region of edges [m], area of one of faces [m^2].
  glm::dvec3 axis{0.0};     ///< Unit, square to the direction; any where the region is as wide as it is long.
  double halfLength = 0.0,  ///< Of the rectangle with the region's second moments, along `axis` [m],
      halfWidth = 0.0;      ///< and across it; 0 for a straight region of edges.
  /// From the centroid, along the two axes, to a point of the region [m]: to itself where it is one. The
  /// centroid of an L or of a ring is not.
  glm::dvec2 inside{0.0};
  std::uint8_t dimension = 0;  ///< 2 where faces overlap, 1 where edges lie on faces or edges, 0 for a point.
};

/// A local minimum distance: no small move of either point along its surface shortens the segment between
/// them. Points are in the frame that the query states; `partPoint - scenePoint` points out of the scene.
struct Lmd {
  glm::dvec3 scenePoint{0.0};  ///< [m]
  glm::dvec3 partPoint{0.0};   ///< [m]
  double distance = 0.0;       ///< > 0 [m]; |partPoint - scenePoint|, but see isRegion.
  glm::dvec3 direction{
      0.0};  ///< Unit, from the scene point to the part point; well defined however near they are.
  std::uint32_t sceneIndex = 0;  ///< Vertex, edge or face of the scene mesh that carries scenePoint.
  std::uint32_t partIndex = 0;   ///< Vertex, edge or face of the part mesh that carries partPoint.
  FeatureKind sceneFeature = FeatureKind::Vertex;
  FeatureKind partFeature = FeatureKind::Vertex;
  /// One representative of a connected flat set of equal minima (faces or edges that are parallel to
  /// kFlatTolerance). The points are at its centroid, the distance is where it is least: in a region that is
  /// tilted within the tolerance the points are farther apart, by the tilt times the way from one to the
  /// other.
  bool isRegion = false;
  /// The segment passes through a surface on its way, so that nothing can move along it: set by markBlocked
  /// alone. No force comes of such a minimum.
  bool isBlocked = false;
  /// Double precision cannot tell whether it is one: a condition for it, or the cutoff, is met by no more
  /// than rounding, or only to the resolution of tolerances.h. It may be none; or a feature beside those
  /// named carries it. What is not marked meets all conditions in exact arithmetic.
  bool isMarginal = false;
  RegionExtent extent;  ///< Of a region.
};

/// A point of the scene that the minimum stands for: of a region one that is surely in it.
inline glm::dvec3 scenePointInside(const Lmd& lmd) noexcept {
  if (!lmd.isRegion) return lmd.scenePoint;
  return lmd.scenePoint + lmd.extent.inside.x * lmd.extent.axis +
         lmd.extent.inside.y * glm::cross(lmd.direction, lmd.extent.axis);
}

/// The same minimum in another frame.
inline Lmd transformed(const Lmd& lmd, const RigidTransform& frameFromQuery) noexcept {
  Lmd out = lmd;
  out.scenePoint = frameFromQuery.applyToPoint(lmd.scenePoint);
  out.partPoint = frameFromQuery.applyToPoint(lmd.partPoint);
  out.direction = frameFromQuery.applyToVector(lmd.direction);
  out.extent.axis = frameFromQuery.applyToVector(lmd.extent.axis);
  return out;
}

}  // namespace nearfit
