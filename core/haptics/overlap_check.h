#pragma once

#include "core/haptics/tracked_scene.h"
#include "core/proximity/broad_phase.h"
#include "core/proximity/lmd_query.h"

namespace nearfit {

/// Which bodies the moving part meets or is inside of at a pose, exactly (interference.h), and how near the
/// others are at the least. Its serial is 0, for the caller to give. Not for the servo thread.
///
/// @param bounds  Of the scene's bodies, in the world.
/// @param within  Bodies farther away than this are not looked at, and `distance` is no more [m].
Clearance findClearance(const ServoScene& scene, const BroadPhase& bounds,
                        const RigidTransform& worldFromPart, double within, LmdScratch& scratch);

}  // namespace nearfit
