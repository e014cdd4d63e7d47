#pragma once

#include <cstdint>
#include <functional>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit {

class NormalConeTree;

/// Where a body first touches another on a straight way.
struct StraightContact {
  bool isFound = false;
  double travel = 0.0;     ///< [m]
  glm::dvec3 normal{0.0};  ///< Of the surfaces where they touch, unit, against the direction.
  glm::dvec3 point{0.0};   ///< Of the part's face that touches: its middle, at contact [m].
  std::uint32_t sceneTriangle = 0, partTriangle = 0;
  std::uint64_t nodePairs = 0;
};

/// How far a part goes along a direction, without turning, until its surface touches another. Surfaces count
/// from either side; whether one body is inside the other at the start is for the caller to know.
///
/// @param scene, part    Hierarchies of the two meshes. Triangles lower than 1e-14 of their longest side are
///                       not in them, and do not count.
/// @param sceneFromPart  Pose of `part` in the frame of `scene` at the start; finite, unit quaternion.
/// @param direction      In the frame of `scene`; unit.
/// @param within         Travel that matters [m]; > 0, may be infinite.
/// @param onWork         Called now and then; may throw to stop the work. May be empty.
/// Exact but for the rounding of coordinates: pairs of boxes, and then of triangles, by the separating axes
/// of moving bodies, the first to meet first. Points and vectors in the frame of `scene`. Allocates.
StraightContact findStraightContact(const NormalConeTree& scene, const NormalConeTree& part,
                                    const RigidTransform& sceneFromPart, const glm::dvec3& direction,
                                    double within, const std::function<void()>& onWork = {});

}  // namespace nearfit
