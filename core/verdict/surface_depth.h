#pragma once

#include <cstdint>
#include <functional>
#include <limits>

#include "core/math/rigid_transform.h"

namespace nearfit {

class NormalConeTree;

/// How deep the surfaces of two bodies lie in each other at the deepest point: the interference of a press fit, however
/// long it is. Bounds [m].
struct SurfaceDepth {
  double least = 0.0;  ///< Depth of the deepest point found.
  double most = std::numeric_limits<double>::infinity();
};

/// Finds the max depth of a point of one surface below the other, to a hundredth, by bounds on ever smaller pieces
/// of triangles, which are cut where triangles of the other surface end. Inside is what the closed components of a
/// body enclose; nothing is deep in an open one.
///
/// @param within      Only whether the depth is within this matters [m]: the search ends once that is known. 0: the depth
///                    itself is wanted.
/// @param maxSamples  Max number of points looked at, some microseconds each. At the bound `most` is what is left.
/// @param goOn        Called now and then; false ends the search likewise. May be empty.
/// Accurate to some roundings of coordinates. Allocates.
SurfaceDepth findSurfaceDepth(const NormalConeTree& scene, const NormalConeTree& part,
                              const RigidTransform& sceneFromPart, double within, std::uint64_t maxSamples,
                              const std::function<bool()>& goOn = {});

}  // namespace nearfit
