#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

// Conditions that remain for contacts once each condition alone holds to the relaxation (ContactReach::turn).
// Where two conditions meet at a sharp corner, a direction within the relaxation of both may be far from the
// corner, or even opposite to it; the bounds of hierarchies allow for the relaxation, but not for that.
// Everything here is real-time safe.

namespace nearfit {

/// True if a direction is no farther than the relaxation from the cone {x : x.e <= 0 for each edge e}.
/// @param apex, neighbours, positions  The edges lead from the apex to each neighbour.
/// @param direction  Unit; violates at least one of the conditions.
/// @param sine       Sine of the allowed angle.
bool isNearPolarCone(const glm::dvec3& apex, std::span<const std::uint32_t> neighbours,
                     std::span<const glm::dvec3> positions, const glm::dvec3& direction,
                     double sine) noexcept;

/// True if a direction perpendicular to an edge is nearer to its polar arc {x : x.t <= 0 for both t} than to
/// the opposite of that arc.
/// @param inward  The two t, perpendicular to the edge and into its faces; of any length.
bool isOnSideOfPolarArc(const std::array<glm::dvec3, 2>& inward, const glm::dvec3& direction) noexcept;

/// True if the foot of a point on a triangle's plane is within `distance` of the triangle [m].
/// @param normal  Unit normal of the triangle.
bool isNearTriangle(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& normal,
                    const glm::dvec3& point, double distance) noexcept;

}  // namespace nearfit
