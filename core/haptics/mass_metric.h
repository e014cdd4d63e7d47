#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/mass_properties.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Measures how far apart two poses of a part are: a metric of mass and inertia, for unit mass. A rotation by
/// a small vector w [rad] about the centre of mass has the length |k w| [m], with k the radii of gyration
/// about the principal axes.
struct MassMetric {
  glm::dquat partFromPrincipal{1.0, 0.0, 0.0, 0.0};  ///< Unit; rotates principal axes into the part's frame.
  glm::dvec3 gyration{1.0};  ///< Radii about the principal axes, smallest first [m]; > 0.
  double radius = 0.0;       ///< Radius of the sphere about the centre of mass that contains the mesh [m].

  /// Rotates principal axes into the world; principalFromWorld() is the inverse.
  glm::dquat worldFromPrincipal(const RigidTransform& worldFromPart) const noexcept {
    return worldFromPart.rotation * partFromPrincipal;
  }
  glm::dquat principalFromWorld(const RigidTransform& worldFromPart) const noexcept {
    return glm::conjugate(worldFromPrincipal(worldFromPart));
  }
};

/// Min radius of gyration, as a fraction of the metric's radius. Without it a needle could turn about itself
/// by any angle at no cost, and the metric's condition would be unbounded. It affects only pins more than
/// some fourteen times as long as wide.
inline constexpr double kMinGyration = 0.05;

/// The metric of a part, valid for bodies of any shape: the radii of gyration are within [kMinGyration, 1]
/// times the radius, whatever the mass properties are. A mesh without extent gets a gyration of 1 m and the
/// radius 0. O(triangles); not for the servo thread.
MassMetric massMetric(const MassProperties& mass, const TriangleMesh& mesh);

}  // namespace nearfit
