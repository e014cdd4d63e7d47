#pragma once

#include <cstdint>
#include <limits>

#include "core/math/rigid_transform.h"

namespace nearfit {

class ComponentsOnDemand;
class NormalConeTree;

/// How two bodies meet.
enum class InterferenceKind : std::uint8_t {
  Disjoint,
  SurfacesMeet,  ///< The surfaces meet or touch.
  PartInside,    ///< The surfaces are apart, but a component of the part is in the scene's solid.
  SceneInside,   ///< The surfaces are apart, but a component of the scene is in the part's solid.
};

/// Result of findInterference.
struct Interference {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  InterferenceKind kind = InterferenceKind::Disjoint;
  /// Two triangles that meet, or a triangle of the component inside; else kNone.
  std::uint32_t sceneTriangle = kNone, partTriangle = kNone;
};

/// Decides exactly if two bodies at a pose have a point in common.
///
/// The part is placed by rounding each of its vertices to double precision in the frame of the scene's mesh,
/// as `sceneFromPart.applyToPoint` does; for those triangles the answer has no tolerance. Surfaces that touch
/// meet. If none do, each component of either mesh (triangles connected through edges) lies wholly inside or
/// outside the other's solid: what its closed components wind around. In a closed component, as many
/// triangles run one way along each edge as the other; one wound the other way inside another is a cavity.
/// Open and inconsistently oriented components contain nothing.
///
/// The answer is that of the hierarchies' meshes; their triangles are named.
///
/// @param scene, part    An empty mesh meets nothing.
/// @param sceneFromPart  Unit quaternion. Throws UsageError if it is not finite.
/// Stops at the first pair of triangles that meet. Allocates, and CGAL's exact numbers are slow where needed:
/// not for the servo thread. O(log n) per component, besides the search for pairs of triangles.
Interference findInterference(const NormalConeTree& scene, const NormalConeTree& part,
                              const RigidTransform& sceneFromPart);

/// A body that is asked about again and again.
struct InterferenceBody {
  const NormalConeTree& tree;
  ComponentsOnDemand& components;  ///< Of the hierarchy's mesh (containment.h).
};
/// The same with components that are kept: those of a body are found once, in time proportional to its triangles.
Interference findInterference(const InterferenceBody& scene, const InterferenceBody& part,
                              const RigidTransform& sceneFromPart);

}  // namespace nearfit
