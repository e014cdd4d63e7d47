#pragma once

#include "core/proximity/query/broad_phase.h"
#include "core/proximity/query/lmd_query.h"
#include "core/servo/tracked_scene.h"

namespace nearfit {

/// Finds exactly which bodies the moving part overlaps or lies inside of at a pose (interference.h), and a
/// lower bound on its distance to the others. Bodies with an invalid pose are skipped. The result's serial is
/// 0, for the caller to set. Not for the servo thread.
///
/// @param bounds  Of the scene's bodies, in the world frame.
/// @param within  Bodies farther away than this are ignored, and the distance returned is at most this [m].
Clearance findClearance(const ServoScene& scene, const BroadPhase& bounds,
                        const RigidTransform& worldFromPart, double within, LmdScratch& scratch);

}  // namespace nearfit
