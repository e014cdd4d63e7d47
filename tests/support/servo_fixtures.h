#pragma once

#include <memory>

#include "core/servo/servo_tick.h"

/// A scene whose every force is known: a cone, tip down, over a floor.
namespace nearfit::test {

/// A cone of height 1 with its tip at its frame's origin, opening upward.
PartGeometryPtr tipDownCone(const glm::dvec3& centre = glm::dvec3(0.0));

/// A slab whose top is the square of side 2 in z = 0.
PartGeometryPtr floorSlab();

/// Where the cone hangs so that its tip is the only minimum: beside the diagonal of the floor's square.
RigidTransform tipAt(double height);

/// A scene of that cone in hand over that slab. The geometries are made once.
std::unique_ptr<ServoScene> coneOverFloor();

/// A scene of which nothing is known yet. Looks at `scene`, which stays alive and as it is.
TrackedScene untrackedView(const ServoScene& scene);

}  // namespace nearfit::test
