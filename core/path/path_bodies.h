#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"
#include "core/math/rigid_transform.h"
#include "core/path/assembly_path.h"
#include "core/scene/scene.h"

namespace nearfit {

/// A part that moves on a path.
struct PathPart {
  Scene::PartPtr part;
  RigidTransform leadFromPart;
  double radius = 0.0;  ///< Upper bound on the distance of its points from the path's centre [m].
  /// Corners of its box, from the path's centre, in the frame of the part that leads [m].
  std::array<glm::dvec3, 8> corners{};
};

/// Parts that a path moves, and those that may be in the way. Keeps the parts of the scene.
struct PathBodies {
  RigidTransform worldFromLead;  ///< In the scene.
  std::vector<PathPart> moving;  ///< Those with triangles, in the path's order; of several, the visible ones.
  /// All other visible parts with triangles, in scene order.
  std::vector<Scene::PartPtr> others;
  double radius = 0.0;  ///< Largest radius of the moving parts.
};

/// Finds the parts of a path in a scene. Throws UsageError if one is not there, or none of them has triangles that can
/// be judged.
PathBodies pathBodies(const Scene& scene, const AssemblyPath& path);

/// Lower bound on the gap between two boxes at a pose [m], each in the frame of its mesh, along the axes of both; 0 if
/// these do not separate them. Rounding is taken off.
double boxGap(const Aabb& other, const Aabb& part, const RigidTransform& otherFromPart) noexcept;

/// How far a part has moved along a path: an upper bound on the length of the way of each of its points.
class PathTravel {
 public:
  PathTravel(const AssemblyPath& path, const PathPart& part);

  /// Travel from the start of the path to a place on it [m]; never falls.
  double at(double place) const noexcept;
  /// A place from `from` to `to` with that travel, to rounding. O(log n).
  double placeAt(double travel, double from, double to) const noexcept;

 private:
  std::vector<double> sums_;  ///< By pose.
};

/// Pose of a moving part in the frame of another, with a unit quaternion.
RigidTransform otherFromPart(const Part& other, const RigidTransform& worldFromLead,
                             const PathPart& moving) noexcept;

/// Error that rounding of poses and their products may make in the place of a point of one mesh in the frame of the
/// other [m].
double placeRounding(const Part& other, const RigidTransform& worldFromLead, const PathPart& moving) noexcept;

}  // namespace nearfit
