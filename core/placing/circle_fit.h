#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

namespace nearfit {

/// A circle in space, or the cylinder through it along its axis.
struct Circle {
  glm::dvec3 centre{0.0}, axis{0.0};  ///< Centre [m]; unit axis.
  double radius = 0.0;                ///< [m]

  /// Distance of a point from the cylinder's surface [m].
  double distanceFromCylinder(const glm::dvec3& point) const noexcept;
  /// Distance of a point from the circle itself [m].
  double distanceFrom(const glm::dvec3& point) const noexcept;
};

/// Least-squares fit of a circle about a given axis (unit) to points projected along it (I. Kåsa, 1976; exact
/// for points on a circle). The centre is at the mean height of the points. std::nullopt for fewer than three
/// points, or collinear ones.
std::optional<Circle> fitCylinder(std::span<const glm::dvec3> points, const glm::dvec3& axis);

/// Same for points near one plane, whose normal is also a least-squares fit.
std::optional<Circle> fitCircle(std::span<const glm::dvec3> points);

}  // namespace nearfit
