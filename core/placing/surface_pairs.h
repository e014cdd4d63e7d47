#pragma once

#include <optional>

#include <glm/vec3.hpp>

#include "core/mesh/exact_surface.h"
#include "core/placing/circle_fit.h"

namespace nearfit {

/// Directions of surfaces that differ by less count as the same [rad]: files round numbers to some eight digits, and no
/// designer means so small an angle.
constexpr double kSameDirection = 1e-6;

/// The point of a surface that is nearest to a point; the point itself for Other, and where all points of the surface
/// are as near, as at the centre of a sphere.
glm::dvec3 nearestOnSurface(const ExactSurface& surface, const glm::dvec3& point) noexcept;

/// True if two surfaces are one around a point, with the material on the same side. Never for Other.
/// @param slack  Max distance between them there [m].
bool areOneSurface(const ExactSurface& a, const ExactSurface& b, const glm::dvec3& near,
                   double slack) noexcept;

/// The circle in which two surfaces meet that is nearest to a point; std::nullopt if they meet in none, as two bores
/// that cross. Both are surfaces of revolution about one axis then, which a plane is about each axis across it and a
/// sphere about each axis through its centre. Its axis is that of a cylinder, cone or torus if there is one.
/// @param slack  Max distance between axes, and of surfaces that touch [m].
std::optional<Circle> circleBetween(const ExactSurface& a, const ExactSurface& b, const glm::dvec3& near,
                                    double slack) noexcept;

/// The line in which two planes meet: its point nearest to `near`, and radius 0. std::nullopt for other surfaces, and
/// for parallel planes.
std::optional<Circle> lineBetween(const ExactSurface& a, const ExactSurface& b,
                                  const glm::dvec3& near) noexcept;

}  // namespace nearfit
