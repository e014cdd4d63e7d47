#pragma once

#include <array>
#include <utility>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

/// A plane that cuts open what is shown: what lies before it, on the side of the normal, is cut away.
struct CutPlane {
  glm::dvec3 normal{0.0, 0.0, 1.0};  ///< Unit.
  double offset = 0.0;               ///< Points p of the plane have dot(normal, p) == offset [m].

  bool operator==(const CutPlane&) const = default;

  /// Positive for what is cut away [m].
  double heightOf(const glm::dvec3& point) const noexcept { return glm::dot(normal, point) - offset; }
};

/// The same plane in another frame.
CutPlane placed(const CutPlane& plane, const RigidTransform& frameFromPlane) noexcept;

/// Unit vectors in the plane, square to each other: seen against the normal, the second is a quarter turn
/// anticlockwise from the first. The same for the same normal.
std::array<glm::dvec3, 2> axesOf(const CutPlane& plane) noexcept;

/// The corners of a rectangle in the plane that a box fills, seen against the normal; anticlockwise. The box
/// is not empty.
std::array<glm::dvec3, 4> sheetOf(const CutPlane& plane, const Aabb& box) noexcept;

/// From where to where a box reaches along a unit direction, as a plane's offset counts [m]; the box is not
/// empty.
std::pair<double, double> reachAlong(const Aabb& box, const glm::dvec3& direction) noexcept;

}  // namespace nearfit
