#pragma once

#include <array>
#include <utility>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// A section plane. The side that the normal points to is cut away.
struct CutPlane {
  glm::dvec3 normal{0.0, 0.0, 1.0};  ///< Unit.
  double offset = 0.0;               ///< Points p of the plane satisfy dot(normal, p) == offset [m].

  bool operator==(const CutPlane&) const = default;

  /// Signed height above the plane [m]; positive on the side cut away.
  double heightOf(const glm::dvec3& point) const noexcept { return glm::dot(normal, point) - offset; }
};

/// Returns the plane in another frame.
CutPlane placed(const CutPlane& plane, const RigidTransform& frameFromPlane) noexcept;

/// Two perpendicular unit vectors in the plane. Seen against the normal, the second is a quarter turn
/// anticlockwise from the first. They depend only on the normal.
std::array<glm::dvec3, 2> axesOf(const CutPlane& plane) noexcept;

/// Corners of the rectangle in the plane that covers a box, seen against the normal; anticlockwise. `box`
/// must not be empty.
std::array<glm::dvec3, 4> sheetOf(const CutPlane& plane, const Aabb& box) noexcept;

/// Lower and upper end of a box along a unit direction, in terms of a plane's offset [m]. `box`
/// must not be empty.
std::pair<double, double> reachAlong(const Aabb& box, const glm::dvec3& direction) noexcept;

}  // namespace nearfit
