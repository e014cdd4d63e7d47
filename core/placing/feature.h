#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit {

enum class FeatureShape : std::uint8_t {
  Plane,   ///< A flat face.
  Axis,    ///< Of a cylinder or a bore; an edge is one too, of radius 0.
  Circle,  ///< A round edge: an axis with a centre.
  Point,   ///< A corner, or any point of a surface.
};

/// What parts are aligned by, in some frame.
struct AlignFeature {
  FeatureShape shape = FeatureShape::Point;
  /// In the plane: the middle of the face; on the axis: the middle of what has it; the centre; the point [m].
  glm::dvec3 point{0.0};
  /// Outward normal; along the axis, of either sense; unit. Zero for a point.
  glm::dvec3 direction{0.0};
  double radius = 0.0;  ///< Of a cylinder or circle [m].
};

/// The same feature in another frame.
inline AlignFeature placed(const AlignFeature& feature, const RigidTransform& frameFromFeature) noexcept {
  AlignFeature moved = feature;
  moved.point = frameFromFeature.applyToPoint(feature.point);
  moved.direction = frameFromFeature.applyToVector(feature.direction);
  return moved;
}

/// A feature of a mesh, in its frame, with what of the mesh shows it.
struct PickedFeature {
  AlignFeature feature;
  std::vector<std::uint32_t> triangles;  ///< Of a face or cylinder.
  std::vector<std::uint32_t>
      vertices;  ///< Along an edge or circle, in order; closed when the last is the first.
};

}  // namespace nearfit
