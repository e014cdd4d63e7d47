#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

namespace nearfit {

/// A circle in space, or a cylinder about the line through its centre along its axis.
struct Circle {
  glm::dvec3 centre{0.0}, axis{0.0};  ///< [m]; unit.
  double radius = 0.0;                ///< [m]

  /// How far a point is from the cylinder's surface [m].
  double distanceFromCylinder(const glm::dvec3& point) const noexcept;
  /// How far a point is from the circle itself [m].
  double distanceFrom(const glm::dvec3& point) const noexcept;
};

/// The circle about an axis of given direction that points lie on when they are seen along it, by least
/// squares (I. Kåsa, 1976: exact for points on a circle); its centre at the height of their mean. Nothing for
/// fewer than three points, or points in a row.
std::optional<Circle> fitCylinder(std::span<const glm::dvec3> points, const glm::dvec3& axis);

/// The same of points in one plane, whose normal is found by least squares too.
std::optional<Circle> fitCircle(std::span<const glm::dvec3> points);

}  // namespace nearfit
