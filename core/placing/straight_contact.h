#pragma once

#include <cstdint>
#include <functional>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit {

class NormalConeTree;

/// The first contact of a body that moves straight toward another.
struct StraightContact {
  bool isFound = false;
  double travel = 0.0;     ///< Before contact [m].
  glm::dvec3 normal{0.0};  ///< Of the touching surfaces, against the direction; unit.
  glm::dvec3 point{0.0};   ///< Centre of the part's touching triangle, at contact [m].
  /// Indices of the touching triangles.
  std::uint32_t sceneTriangle = 0, partTriangle = 0;
  /// Pairs of nodes examined.
  std::uint64_t nodePairs = 0;
};

/// How far a part can move along a direction, without rotation, until its surface touches another. Both sides
/// of surfaces count. The caller must know whether one body is inside the other at the start.
///
/// @param scene, part    Hierarchies of the two meshes. They omit triangles lower than 1e-14 of their longest
///                       side, which do not count.
/// @param sceneFromPart  Pose of `part` in the frame of `scene` at the start; finite, unit quaternion.
/// @param direction      In the frame of `scene`; unit.
/// @param within         Max travel of interest [m]; > 0, may be infinite.
/// @param onWork         Called now and then; may throw to stop the work. May be empty.
/// Exact up to rounding of coordinates. Separating axes of moving bodies, for pairs of boxes and then of
/// triangles, in order of first contact. Points and vectors are in the frame of `scene`. Allocates.
StraightContact findStraightContact(const NormalConeTree& scene, const NormalConeTree& part,
                                    const RigidTransform& sceneFromPart, const glm::dvec3& direction,
                                    double within, const std::function<void()>& onWork = {});

}  // namespace nearfit
