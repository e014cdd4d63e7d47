#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/scene/scene.h"
#include "tests/bench/hand_path.h"

namespace nearfit::bench {

struct Ball {
  glm::dvec3 centre{0.0};
  double radius = 0.0;  ///< [m]
};

/// Holds the scene, and the part at each pose of a path.
Ball ballAround(const PathBodies& bodies, std::span<const RigidTransform> path);

/// Where parts may stand that are never near.
struct FarField {
  Ball keepOut;
  double size = 1.0;     ///< That parts are measured against: the largest is about half as large [m].
  double spacing = 0.5;  ///< Edge of the cube of space that each part has on average [m].
  std::uint64_t seed = 1;
};

/// A dozen of geometries, of a few hundred to some thousands of triangles, in several sizes. No hierarchies
/// yet.
std::vector<PartGeometryPtr> farGeometries(double size);

/// Parts at random poses around the ball and not in it, with names of their own; same field, same poses.
/// Some stand right beside it. They may overlap each other: nothing asks for distances between them.
/// @param geometries  Shown in turn; not empty.
std::vector<Part> farParts(const FarField& field, std::span<const PartGeometryPtr> geometries,
                           std::size_t count);

}  // namespace nearfit::bench
