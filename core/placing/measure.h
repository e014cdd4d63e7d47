#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"
#include "core/placing/feature.h"

namespace nearfit {

/// One end of a measurement, in some frame.
struct MeasureEnd {
  glm::dvec3 point{0.0};  ///< That the distance is measured to [m].
  AlignFeature feature;   ///< What was pointed at: for angles, and distances square to it.
};

/// What somebody measures from who points at a feature of a mesh, in its frame: a corner, the centre of a
/// circle, the nearest point of an edge, else the very point of the face.
/// @param hit  The point of the surface that was pointed at [m].
MeasureEnd measureEnd(const TriangleMesh& mesh, const PickedFeature& picked, const glm::dvec3& hit);

/// The same end in another frame.
inline MeasureEnd placed(const MeasureEnd& end, const RigidTransform& frameFromEnd) noexcept {
  return {frameFromEnd.applyToPoint(end.point), placed(end.feature, frameFromEnd)};
}

/// What lies between two ends.
struct Measurement {
  glm::dvec3 from{0.0}, to{0.0};  ///< The points of the ends [m].
  double distance = 0.0;          ///< Between them [m].
  /// Between the planes, axes and points that the ends are of [m]: square to them; of a circle and a plane,
  /// from its centre. Nothing where they run into each other, or are two points.
  std::optional<double> apart;
  /// Between the directions of faces and axes, from 0 to a right angle [rad]; between a face and an axis that
  /// of the axis to the face. Nothing where one has no direction.
  std::optional<double> angle;
};

/// Directions that differ by less count as parallel, and planes and lines are apart then [rad]: a tenth of a
/// degree, as meshes have rounded normals.
constexpr double kParallelAngle = 1.745e-3;

/// @param from, to  In one frame; directions unit, everything finite.
Measurement measure(const MeasureEnd& from, const MeasureEnd& to) noexcept;

}  // namespace nearfit
