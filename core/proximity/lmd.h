#pragma once

#include <cstdint>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit {

/// Kind of mesh feature.
enum class FeatureKind : std::uint8_t { Vertex, Edge, Face };

/// "vertex", "edge" or "face".
inline const char* nameOf(FeatureKind kind) noexcept {
  switch (kind) {
    case FeatureKind::Vertex:
      return "vertex";
    case FeatureKind::Edge:
      return "edge";
    case FeatureKind::Face:
      break;
  }
  return "face";
}

/// Extent of a flat region, seen along its direction, on two axes: the long axis `axis`, and
/// direction x `axis`.
struct RegionExtent {
  double measure = 0.0;  ///< Length of a region of edges [m], area of a region of faces [m^2].
  glm::dvec3 axis{0.0};  ///< Unit, perpendicular to the direction; arbitrary if length equals width.
  /// Half length along `axis`, and half width across it, of the rectangle with the region's second moments
  /// [m]. The width is 0 for a straight region of edges.
  double halfLength = 0.0, halfWidth = 0.0;
  /// Offset along the two axes from the centroid to a point inside the region [m]. Zero if the centroid is
  /// inside; that of an L or a ring is not.
  glm::dvec2 inside{0.0};
  std::uint8_t dimension = 0;  ///< 2: overlapping faces, 1: an edge on a face or edge, 0: a point.
};

/// Local minimum distance (LMD): no small move of either point along its surface shortens the segment between
/// them. The query states the frame of the points; `partPoint - scenePoint` points out of the scene.
struct Lmd {
  glm::dvec3 scenePoint{0.0};  ///< [m]
  glm::dvec3 partPoint{0.0};   ///< [m]
  double distance = 0.0;       ///< > 0 [m]; equals |partPoint - scenePoint| except in a region, see isRegion.
  glm::dvec3 direction{0.0};   ///< Unit, from scenePoint to partPoint; accurate at any distance.
  std::uint32_t sceneIndex = 0;  ///< Vertex, edge or face of the scene mesh that carries scenePoint.
  std::uint32_t partIndex = 0;   ///< Vertex, edge or face of the part mesh that carries partPoint.
  FeatureKind sceneFeature = FeatureKind::Vertex;
  FeatureKind partFeature = FeatureKind::Vertex;
  /// True if this stands for a connected flat region of equal minima (faces or edges parallel to within
  /// kFlatTolerance). The points are at its centroid; `distance` is its min distance. In a region tilted
  /// within the tolerance the points are farther apart, by the tilt times the way to where it is nearest.
  bool isRegion = false;
  /// True if the segment passes through a surface, so that nothing can move along it. Only markBlocked sets
  /// it. Such a minimum exerts no force.
  bool isBlocked = false;
  /// True if double precision cannot decide that this is a minimum: a condition, or the cutoff, holds only
  /// within rounding or within the resolution of tolerances.h. It may be none, or a neighbouring feature may
  /// carry it. An unmarked minimum meets all conditions in exact arithmetic.
  bool isMarginal = false;
  /// True if a nearer minimum stands for the area of contact that both belong to. Only mergeAreas sets it. Such a
  /// minimum exerts no force.
  bool isMerged = false;
  RegionExtent extent;  ///< Valid if isRegion.
};

/// Returns a scene point that represents the minimum [m]; for a region, one that is surely inside it.
inline glm::dvec3 scenePointInside(const Lmd& lmd) noexcept {
  if (!lmd.isRegion) return lmd.scenePoint;
  return lmd.scenePoint + lmd.extent.inside.x * lmd.extent.axis +
         lmd.extent.inside.y * glm::cross(lmd.direction, lmd.extent.axis);
}

/// Returns the same minimum in another frame.
/// @param frameFromQuery  Maps the frame of `lmd` to the new one.
inline Lmd transformed(const Lmd& lmd, const RigidTransform& frameFromQuery) noexcept {
  Lmd out = lmd;
  out.scenePoint = frameFromQuery.applyToPoint(lmd.scenePoint);
  out.partPoint = frameFromQuery.applyToPoint(lmd.partPoint);
  out.direction = frameFromQuery.applyToVector(lmd.direction);
  out.extent.axis = frameFromQuery.applyToVector(lmd.extent.axis);
  return out;
}

}  // namespace nearfit
