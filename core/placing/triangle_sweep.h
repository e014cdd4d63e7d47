#pragma once

#include <glm/vec3.hpp>

#include "core/math/triangle_corners.h"

namespace nearfit {

/// Where two triangles come to touch on a straight way.
struct SweepHit {
  double travel = 0.0;     ///< Along the direction; infinity when they never do.
  glm::dvec3 normal{0.0};  ///< Of the plane that they touch in, unit, against the direction; zero at once.
};

/// How far `moving` goes along `direction` until it touches `fixed`, nothing turning; 0 where they touch
/// already. Triangles are the convex hulls of their corners, whatever their side.
///
/// @param direction  Unit.   @param within  More travel than this need not be told apart from infinity.
/// Before the travel that is returned they are apart, to rounding of the corners. Where the way only grazes,
/// so that rounding alone decides, they touch.
/// Exact separating axes of a moving polytope (S. Gottschalk's, in D. Eberly's dynamic form), with those in
/// the triangles' planes for pairs that are parallel. Real-time safe.
SweepHit sweepTriangles(const TriangleCorners& fixed, const TriangleCorners& moving,
                        const glm::dvec3& direction, double within) noexcept;

}  // namespace nearfit
