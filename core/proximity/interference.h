#pragma once

#include <cstdint>
#include <limits>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

namespace nearfit {

class NormalConeTree;

/// A mesh with the hierarchy that was built of it.
struct MeshBody {
  const TriangleMesh& mesh;
  const NormalConeTree& tree;
};

enum class InterferenceKind : std::uint8_t {
  Disjoint,
  SurfacesMeet,  ///< Touching counts.
  PartInside,    ///< The surfaces are apart, but a piece of the part lies in the scene's solid.
  SceneInside,   ///< The surfaces are apart, but a piece of the scene's lies in the part's solid.
};

struct Interference {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  InterferenceKind kind = InterferenceKind::Disjoint;
  /// Two triangles that meet, or one of the piece that lies inside; else kNone.
  std::uint32_t sceneTriangle = kNone, partTriangle = kNone;
};

/// Whether two bodies that stand at a pose have a point in common, decided exactly.
///
/// The part is placed by rounding each of its vertices to double precision in the frame of the scene's mesh,
/// as `sceneFromPart.applyToPoint` does: for those triangles the answer has no tolerance. Surfaces that touch
/// meet. Where none do, each piece of either mesh (triangles connected through edges) lies wholly inside or
/// outside the other's solid: that is what its closed pieces wind around, those along each of whose edges as
/// many triangles run one way as the other. A piece wound the other way inside one is a cavity; open pieces
/// and inconsistently oriented ones contain nothing.
///
/// @param scene, part    Each with its own hierarchy; an empty mesh meets nothing.
/// @param sceneFromPart  Finite, unit quaternion. Throws UsageError when it is not finite.
/// Stops at the first pair of triangles that meet. Allocates, and CGAL's exact numbers are slow where it
/// needs them: not for the servo thread. O(log n) a piece of a mesh, besides the search for pairs of
/// triangles.
Interference findInterference(const MeshBody& scene, const MeshBody& part,
                              const RigidTransform& sceneFromPart);

}  // namespace nearfit
