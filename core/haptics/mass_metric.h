#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/mass_properties.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// How far apart two poses of a part count: a metric of mass and inertia, as for a body of mass one. A turn
/// by a small vector w [rad] about the centre of mass counts as the length |k w| [m], with k the radii of
/// gyration along the principal axes.
struct MassMetric {
  glm::dquat partFromPrincipal{1.0, 0.0, 0.0, 0.0};  ///< Unit; turns principal axes into the part's frame.
  glm::dvec3 gyration{1.0};                          ///< About the principal axes, smallest first [m]; > 0.
  double radius = 0.0;  ///< Of the sphere about the centre of mass that holds the mesh [m].

  /// Turns principal axes into the world's, and back.
  glm::dquat worldFromPrincipal(const RigidTransform& worldFromPart) const noexcept {
    return worldFromPart.rotation * partFromPrincipal;
  }
  glm::dquat principalFromWorld(const RigidTransform& worldFromPart) const noexcept {
    return glm::conjugate(worldFromPrincipal(worldFromPart));
  }
};

/// No radius of gyration counts as less than this fraction of the metric's radius: a needle would else turn
/// about itself for nothing, by any angle, and the metric's condition would grow without bound. Only pins
/// more than some fourteen times as long as wide are below it.
inline constexpr double kLeastGyration = 0.05;

/// The metric of a part, safe for bodies of any shape: gyration is within [kLeastGyration, 1] times the
/// radius whatever the mass properties say. A mesh without extent gets a gyration of 1 m and the radius 0.
/// O(triangles); not for the servo thread.
MassMetric massMetric(const MassProperties& mass, const TriangleMesh& mesh);

}  // namespace nearfit
