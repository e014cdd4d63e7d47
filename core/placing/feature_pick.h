#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"
#include "core/placing/feature.h"

namespace nearfit {

/// Which features are looked for.
enum class FeatureFilter : std::uint8_t {
  Any,     ///< What is nearest in this order: corner, edge or circle, cylinder, flat face.
  Faces,   ///< Flat faces; facets of something round too.
  Axes,    ///< Cylinders, circles and edges.
  Points,  ///< Corners, centres of circles; else the very point.
};

/// Where a ray or the mouse hit a mesh, in its frame.
struct SurfaceHit {
  std::uint32_t triangle = 0;
  glm::dvec3 point{0.0};  ///< [m]
};

/// The feature that somebody means who points at a mesh.
///
/// @param hit    Its triangle is one of the mesh.
/// @param reach  How far from the point corners and edges may be to be meant [m]; >= 0.
/// A flat face is the connected triangles in one plane, a cylinder those on one (at least four facets), a
/// circle or edge a chain of sharp edges. Nothing where the mesh has no such feature there. Takes some
/// milliseconds where the feature has tens of thousands of triangles: for the GUI thread, not for the servo.
std::optional<PickedFeature> pickFeature(const TriangleMesh& mesh, const SurfaceHit& hit, double reach,
                                         FeatureFilter filter = FeatureFilter::Any);

}  // namespace nearfit
