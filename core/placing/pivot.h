#pragma once

#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/placing/view_projection.h"
#include "core/scene/scene.h"

namespace nearfit {

/// A part as shown, which may be away from its pose in the scene during a drag or in the hand.
struct PlacedPart {
  const Part* part = nullptr;  ///< Has a geometry.
  /// Pose as shown.
  RigidTransform worldFromPart;
};

/// Common centre of mass, in the world frame [m]. Parts are weighted by mass (density times volume), or
/// equally if none has a mass.
/// @param parts  Not empty.
glm::dvec3 centreOfMass(std::span<const PlacedPart> parts) noexcept;

/// Centre of the bounding box of all parts, in the world frame [m]. The box is aligned with the first part,
/// so that its centre moves with the parts.
/// @param parts  Not empty.
glm::dvec3 boxCentre(std::span<const PlacedPart> parts) noexcept;

/// The pivot that all parts share, in the world frame [m]; std::nullopt if a part has none or a
/// different one. Parts that moved together still share it: the tolerance is kPivotSlack plus rounding
/// of the coordinates.
/// @param parts  Not empty.
std::optional<glm::dvec3> sharedPivot(std::span<const PlacedPart> parts) noexcept;
constexpr double kPivotSlack = 1e-9;  ///< Nobody aims at a nanometre [m].

/// True if the line of sight, extended both ways, meets the part's bounding box: a cheap test
/// before a closer look.
bool meetsBox(const ViewRay& ray, const PlacedPart& part) noexcept;

}  // namespace nearfit
