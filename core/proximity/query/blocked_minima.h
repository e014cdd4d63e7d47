#pragma once

#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/lmd.h"
#include "core/proximity/query/lmd_query.h"

namespace nearfit {

class NormalConeTree;

/// Sets `isBlocked` of each minimum: true if its segment, between its ends, passes through the surface of
/// either body. Such a minimum (through a thin wall, or between overlapping components of one mesh) meets the
/// definition, but nothing can move along it. A surface that the segment only touches does not count: the one
/// that carries an end, or an edge or face that it grazes. For a flat region, one segment inside it decides.
///
/// @param scene, part    Hierarchies of the two meshes.
/// @param sceneFromPart  Pose at which the minima were found.
/// @param lmds           From findLmds or a candidate list: points in the frame of the scene's mesh.
/// @param leastDistance  Lower bound on the distance between the surfaces [m]; saves most of the work. If the
///                       bodies do not interpenetrate, pass the distance of the nearest minimum (of the
///                       complete set); if they may, 0.
/// @param scratch        Provides the instruction set only.
/// Real-time safe. Costs about one ray cast per minimum and body: O(log n). Does nothing if a hierarchy is
/// empty or the pose is not finite.
void markBlocked(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                 std::span<Lmd> lmds, double leastDistance, LmdScratch& scratch) noexcept;

}  // namespace nearfit
