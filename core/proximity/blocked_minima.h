#pragma once

#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/lmd.h"
#include "core/proximity/lmd_query.h"

namespace nearfit {

class NormalConeTree;

/// Sets `isBlocked` of each minimum: whether its segment, between its ends, passes through the surface of
/// either body. Such a minimum (through a thin wall, or between components of one mesh that overlap) is one
/// by definition, but nothing can move along it. What the segment only touches does not count: the surface
/// that carries its ends, an edge or a face that it grazes. For a flat region the segment at a point of the
/// region stands for all.
///
/// @param scene, part    Hierarchies of the two meshes.
/// @param sceneFromPart  The pose that the minima were found at.
/// @param lmds           As findLmds or a candidate list gave them: points in the frame of the scene's mesh.
/// @param leastDistance  No point of one surface is nearer to the other than this [m]. Where the bodies do
/// not
///                       interpenetrate, that is the distance of the nearest minimum (of the complete set),
///                       and most of the work is spared. 0 where they may interpenetrate.
/// @param scratch        For its instruction set alone.
/// Real-time safe. About the cost of a ray cast a minimum and body: O(log n).
void markBlocked(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                 std::span<Lmd> lmds, double leastDistance, LmdScratch& scratch) noexcept;

}  // namespace nearfit
