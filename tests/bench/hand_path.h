#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit::bench {

/// Where a part is nearest to the scene.
struct Nearest {
  double distance;       ///< [m], > 0
  glm::dvec3 direction;  ///< Unit, from the scene to the part, in the scene's frame.
};

/// Finds it at a sceneFromPart; none when it is farther than the probe's reach.
using DistanceProbe = std::function<std::optional<Nearest>(const RigidTransform& sceneFromPart)>;

/// The bodies, as far as a path asks.
struct PathBodies {
  glm::dvec3 sceneCentre, partCentre;  ///< Of the bounding boxes, each in its own frame [m].
  double sceneRadius, partRadius;      ///< Of spheres about those centres that hold the bodies [m].
  double size;                         ///< The larger diagonal [m].
};

struct HandPathOptions {
  std::size_t poses = 2000;
  double step = 0.001;       ///< A pose's translation, as a fraction of the size.
  double turn = 0.00349066;  ///< A pose's rotation [rad]: 0.2 degrees.
  double cutoff = 0.0;       ///< Distance to stay within, most of the time [m].
  double reach = 0.0;        ///< Of the probe [m]; > cutoff.
  std::uint64_t seed = 1;
  std::optional<RigidTransform> start;  ///< Else the part comes in from outside, at any orientation.
  /// Farthest that the part's centre goes from where the path begins [m].
  std::optional<double> range;
};

/// A path as a hand moves a part near a scene: directions of motion change smoothly, the distance comes and
/// goes. No pose and no motion between two poses interpenetrates: before each step no point can move as far
/// as the least distance. Where that leaves no room for a whole step, and none aside, the step is shorter.
/// Same options and distances, same path. Throws Error when the part never comes near or starts in contact.
std::vector<RigidTransform> handPath(const PathBodies& bodies, const DistanceProbe& probe,
                                     const HandPathOptions& options);

/// Upper bound of how far any point of the part moves between two poses [m]; the part is held as in
/// `PathBodies`.
double motionBound(const PathBodies& bodies, const RigidTransform& from, const RigidTransform& to);

}  // namespace nearfit::bench
