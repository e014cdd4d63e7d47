#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/proximity/query/lmd_query.h"
#include "core/verdict/convex_depth.h"

namespace nearfit {

class NormalConeTree;

/// Translation that frees two bodies that overlap, or of which one contains the other.
struct ClashDepth {
  FreeingTranslation translation;  ///< Moves the part; in the frame of the scene's mesh.
  /// True if no shorter one frees it; else the depth is at most its length.
  bool isExact = false;
};

/// A body as findClashDepth() needs it.
struct DepthBody {
  const NormalConeTree& tree;
  const ConvexBody* convex = nullptr;  ///< convexBodyOf() its mesh; null if it is not convex.
};

/// Bounds on the work of findClashDepth().
struct DepthLimits {
  std::uint64_t maxNodePairs = 500'000;  ///< About half a second.
  std::function<bool()> goOn = {};       ///< Called now and then; false ends the search. May be empty.
};

/// Finds a short translation of `part`, without rotation, that frees it from `scene`: after it, by the exact predicate
/// (interference.h), they have no point in common. Of two convex bodies it is the shortest (convex_depth.h).
///
/// For others it is the shortest of the ways out that were tried: along the normals where the surfaces meet, along axes
/// and between them, and from the best of these along the planes that still block it. The way out along a direction is
/// exact: pairs of triangles block ranges of it, and it ends at the first place that none blocks and where neither body
/// is inside the other. Where only touching blocks it, directions tilted by a thousandth are tried.
///
/// @param scene, part  Overlap, or one contains the other, as findInterference() says; that is not decided again.
/// @param scratch      Work space, one per thread.
/// No value if no way out was found within the limits. Allocates.
std::optional<ClashDepth> findClashDepth(const DepthBody& scene, const DepthBody& part,
                                         const RigidTransform& sceneFromPart, LmdScratch& scratch,
                                         const DepthLimits& limits = {});

}  // namespace nearfit
