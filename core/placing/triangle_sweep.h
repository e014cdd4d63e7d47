#pragma once

#include <glm/vec3.hpp>

#include "core/math/triangle_corners.h"

namespace nearfit {

/// The first contact of two triangles in a straight motion.
struct SweepHit {
  double travel = 0.0;  ///< Along the direction; infinity if they never touch.
  /// Of the plane in which they touch, against the direction; unit. Zero if they touch at the start.
  glm::dvec3 normal{0.0};
};

/// How far `moving` goes along `direction`, without rotation, until it touches `fixed`; 0 if they already
/// touch. A triangle is the convex hull of its corners; both sides count.
///
/// @param direction  Unit.
/// @param within     Max travel of interest; longer ones may be returned as infinity.
/// Before the returned travel the triangles are apart, up to rounding of the corners. If rounding alone
/// decides a grazing motion, they touch.
/// Exact separating axes of moving polytopes (S. Gottschalk's, in D. Eberly's dynamic form), including those
/// in the triangles' planes for parallel pairs. Real-time safe.
SweepHit sweepTriangles(const TriangleCorners& fixed, const TriangleCorners& moving,
                        const glm::dvec3& direction, double within) noexcept;

}  // namespace nearfit
