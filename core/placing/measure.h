#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/mesh/exact_surface.h"
#include "core/mesh/triangle_mesh.h"
#include "core/placing/feature.h"

namespace nearfit {

/// One end of a measurement, in some frame.
struct MeasureEnd {
  glm::dvec3 point{0.0};  ///< Distances are measured to this point [m].
  AlignFeature feature;   ///< The feature pointed at: for angles and perpendicular distances.
  /// Where a straight edge begins and ends along its feature's direction, from the feature's point [m]; else none.
  std::optional<glm::dvec2> extent = {};
};

/// The end of a measurement at a picked feature, in the mesh's frame: a corner, the centre of a circle or sphere, the
/// nearest point of an edge, otherwise the point of the face itself. On an exact face it is the nearest point of its
/// surface, not of a facet.
/// @param hit  Point of the mesh's surface pointed at [m].
/// @param surfaces  As given to pickFeature().
MeasureEnd measureEnd(const TriangleMesh& mesh, const PickedFeature& picked, const glm::dvec3& hit,
                      const SurfaceFaces* surfaces = nullptr);

/// Returns the end in another frame.
inline MeasureEnd placed(const MeasureEnd& end, const RigidTransform& frameFromEnd) noexcept {
  return {frameFromEnd.applyToPoint(end.point), placed(end.feature, frameFromEnd), end.extent};
}

/// A measurement between two ends.
struct Measurement {
  /// Points of the ends [m]; between parallel faces, between an axis or edge and a parallel one or face, and between a
  /// corner or centre and an edge that it lies beside, the ends of a perpendicular.
  glm::dvec3 from{0.0}, to{0.0};
  double distance = 0.0;  ///< Between these points [m].
  /// Where `distance` is the perpendicular one: distance between the points of the ends [m].
  std::optional<double> pointToPoint;
  /// Between parallel faces that point towards each other: how far the second lies in front of the first [m].
  /// Negative if it lies behind it, as where parts overlap.
  std::optional<double> gap;
  /// Perpendicular distance between the ends' planes, axes and points; for a circle and a plane, from the
  /// circle's centre [m], as for a circle and an edge. std::nullopt if they are two points, or otherwise not parallel.
  std::optional<double> apart;
  /// Angle between the directions of faces and axes, or between an axis and a face [rad]; 0 to pi / 2.
  /// std::nullopt if one has no direction.
  std::optional<double> angle;
};

/// Directions that differ by less count as parallel [rad]: a tenth of a degree, since meshes have
/// rounded normals.
constexpr double kParallelAngle = 1.745e-3;

/// A smaller gap counts as touching [m]: what rounding comes to.
constexpr double kTouchingGap = 1e-7;

/// Measures between two ends.
/// @param from, to  In one frame; unit directions, everything finite.
Measurement measure(const MeasureEnd& from, const MeasureEnd& to) noexcept;

}  // namespace nearfit
