#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

// What is left to ask of contacts once every condition alone is met to the relaxation (ContactReach::turn).
// Where two conditions meet at a sharp corner, what is within the relaxation of both may be far from the
// corner, or even opposite to it: the bounds of hierarchies allow for the relaxation, not for that. All here
// is real-time safe.

namespace nearfit {

/// Whether a direction is no farther than the relaxation from a cone {x : x.e <= 0 for each edge e}.
/// @param apex, neighbours, positions  The edges lead from the apex to each neighbour.
/// @param direction  Unit; off one of the conditions at least.
/// @param sine       Of the angle that is allowed.
bool isNearPolarCone(const glm::dvec3& apex, std::span<const std::uint32_t> neighbours,
                     std::span<const glm::dvec3> positions, const glm::dvec3& direction,
                     double sine) noexcept;

/// Whether a direction square to an edge is nearer to its polar arc {x : x.t <= 0 for both t} than to the
/// opposite of that.
/// @param inward  The two t, square to the edge and into its faces; of any length.
bool isOnSideOfPolarArc(const std::array<glm::dvec3, 2>& inward, const glm::dvec3& direction) noexcept;

/// Whether the foot of a point on a triangle's plane is no farther from the triangle than that [m].
/// @param normal  Of the triangle; unit.
bool isNearTriangle(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& normal,
                    const glm::dvec3& point, double distance) noexcept;

}  // namespace nearfit
