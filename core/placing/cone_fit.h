#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

namespace nearfit {

/// The wall of a cone or, with slope 0, of a cylinder.
struct Cone {
  glm::dvec3 centre{0.0}, axis{0.0};  ///< A point on the axis [m]; unit axis.
  double radius = 0.0;                ///< Around the centre [m].
  double slope = 0.0;                 ///< By which the radius grows along the axis.

  /// Angle between wall and axis [rad]; >= 0.
  double halfAngle() const noexcept;
  /// Height of a point above the centre, along the axis [m].
  double heightOf(const glm::dvec3& point) const noexcept;
  /// Distance of a point from the wall [m].
  double distanceFrom(const glm::dvec3& point) const noexcept;
  /// The same cone, its centre moved along the axis [m].
  Cone movedTo(double height) const noexcept;
};

/// Least-squares fit of a cone to points on its wall, from a guess: Levenberg-Marquardt on the distances. Its centre is
/// at the mean height of the points. Nullopt if it fails, or the points are fewer than its parameters.
/// @param isCylinder  Keeps the slope at 0.
std::optional<Cone> fitCone(std::span<const glm::dvec3> points, const Cone& guess, bool isCylinder = false);

}  // namespace nearfit
