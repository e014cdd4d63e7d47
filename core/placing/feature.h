#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/exact_surface.h"

namespace nearfit {

/// Shapes of features that parts can be aligned by.
enum class FeatureShape : std::uint8_t {
  Plane,   ///< A flat face.
  Axis,    ///< Of a cylinder, a bore or a cone; an edge is an axis of radius 0.
  Circle,  ///< A round edge, or the middle of a torus's tube: an axis with a centre.
  Point,   ///< A corner, the centre of a sphere, or any point of a surface.
};

/// A feature by which parts are aligned, in some frame.
struct AlignFeature {
  FeatureShape shape = FeatureShape::Point;
  /// Plane: middle of the face. Axis: middle of the wall or edge. Circle: centre. Point: the point [m].
  glm::dvec3 point{0.0};
  /// Outward normal, or direction along the axis, of either sign; unit. Zero for a point.
  glm::dvec3 direction{0.0};
  double radius = 0.0;       ///< For a cylinder, sphere or circle; of a cone halfway along its wall [m].
  double halfAngle = 0.0;    ///< Between the wall of a cone and its axis [rad]; else 0.
  std::uint32_t flats = 0;   ///< For the axis of a prism, else 0. The radius is then that of its corners.
  double minorRadius = 0.0;  ///< Radius of the tube of a torus [m]; else 0.
  /// Kind of the exact surface whose feature it is; Other for edges, corners and features estimated from facets.
  SurfaceKind surface = SurfaceKind::Other;
  bool isExact = false;  ///< Comes from exact surfaces, whatever the facets.
};

/// Returns the feature in another frame.
inline AlignFeature placed(const AlignFeature& feature, const RigidTransform& frameFromFeature) noexcept {
  AlignFeature moved = feature;
  moved.point = frameFromFeature.applyToPoint(feature.point);
  moved.direction = frameFromFeature.applyToVector(feature.direction);
  return moved;
}

/// A feature of a mesh, in the mesh's frame, and the triangles or vertices that show it.
struct PickedFeature {
  AlignFeature feature;
  std::vector<std::uint32_t> triangles;  ///< Triangles of a face or wall.
  /// Along an edge or circle, in order; if closed, the first is repeated at the end.
  std::vector<std::uint32_t> vertices;
};

}  // namespace nearfit
