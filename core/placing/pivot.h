#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/placing/view_projection.h"
#include "core/scene/scene.h"

namespace nearfit {

/// A part where it is shown, which a drag or a hand may have away from its pose in the scene.
struct PlacedPart {
  const Part* part = nullptr;  ///< With a geometry.
  RigidTransform worldFromPart;
};

/// Of all parts together, in the world [m]; goes with them. The parts weigh by density and volume; where none
/// has a mass all count alike. @param parts  Not empty.
glm::dvec3 centreOfMass(std::span<const PlacedPart> parts) noexcept;

/// The middle of the box around all parts, in the world [m]. The box lies along the axes of the first part,
/// so that its middle goes with the parts when they are moved together. @param parts  Not empty.
glm::dvec3 boxCentre(std::span<const PlacedPart> parts) noexcept;

/// The pivot that all parts were given together, in the world [m]; nothing where one has none, or another.
/// Parts that have moved together since still share it: kPivotSlack and what rounds at the coordinates' size.
/// @param parts  Not empty.
std::optional<glm::dvec3> sharedPivot(std::span<const PlacedPart> parts) noexcept;
constexpr double kPivotSlack = 1e-9;  ///< Nobody aims at a nanometre [m].

/// Whether a ray meets the box around a part, so that it is worth while to look closer.
bool meetsBox(const ViewRay& ray, const PlacedPart& part) noexcept;

}  // namespace nearfit
