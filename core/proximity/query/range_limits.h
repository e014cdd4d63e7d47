#pragma once

#include "core/math/rigid_transform.h"
#include "core/proximity/query/cull_kernel.h"
#include "core/proximity/query/lmd_query.h"
#include "core/proximity/query/motion_budget.h"

namespace nearfit {

/// Cull limits for a whole range of motion.
struct RangeLimits {
  CullLimits still;
  CullSweep inScene, inPart;  ///< The stretch, in the frame of either tree.
};

/// Returns limits that hold at every pose of a range.
///
/// A pair that carries a minimum at a pose X is within the cutoff there, and X is within the budget of a pose
/// P on the stretch. Let o be the part's centre. Seen from the scene, a point q of the part moves from the
/// middle to P by t (shift + spin x (q - o)), but for the curvature of its arc, at most |spin|^2 |q - o| / 2.
/// Seen from the part, a point a of the scene moves by the opposite with a for q, but for its arc about o and
/// for the rotation of the shift, |spin| |shift|. From P to X the motion is at most the budget's travel; seen
/// from the part, its turn times the distance of the two points adds to that.
///
/// @param centred  Middle of the range, between the trees' centred frames.
/// @param range    In the axes of the scene.
RangeLimits rangeLimits(const BodyPairQuery& query, const RigidTransform& centred,
                        const MotionRange& range) noexcept;

/// Widens a range for contacts. A contact's direction is off the limits of either body by the relaxation at
/// most, and its points off their features by as much of the distance: together, by up to twice that.
MotionRange relaxed(MotionRange range, double cutoff, double relaxation) noexcept;

/// Returns cull limits for contacts at a pose between the centred frames, or within `slack` of it.
CullLimits contactLimits(const BodyPairQuery& query, const RigidTransform& centred, double relaxation,
                         const MotionBudget& slack) noexcept;

}  // namespace nearfit
