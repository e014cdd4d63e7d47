#pragma once

#include "core/math/rigid_transform.h"
#include "core/proximity/cull_kernel.h"
#include "core/proximity/lmd_query.h"
#include "core/proximity/motion_budget.h"

namespace nearfit {

/// What bounds are held against for a whole range of motion.
struct RangeLimits {
  CullLimits still;
  CullSweep inScene, inPart;  ///< The stretch, in the frame of either tree.
};

/// Limits that hold at every pose of a range.
///
/// A pair that carries a minimum at a pose X is within the cutoff there. X is within the budget of a pose P
/// on the stretch. Seen from the scene, a point q of the part goes from where it is in the middle to P by t
/// (shift + spin x (q - o)), o the part's centre, but for the curvature of its arc, |spin|^2 |q - o| / 2;
/// seen from the part, a point a of the scene by the opposite with a for q, but for an arc about o as well
/// and for the shift's turning, |spin| |shift|. From P to X it is the budget's travel, and seen from the part
/// its turn times the distance of the two points besides.
RangeLimits rangeLimits(const BodyPairQuery& query, const RigidTransform& centred,
                        const MotionRange& range) noexcept;

/// A contact's direction is off the limits of either body by the relaxation at most, and its points off their
/// features by as much of the distance: the limits of both are up to twice as far from each other.
MotionRange relaxed(MotionRange range, double cutoff, double relaxation) noexcept;

/// What bounds are held against for contacts at a pose between centred frames.
CullLimits contactLimits(const BodyPairQuery& query, const RigidTransform& centred, double relaxation,
                         const MotionBudget& slack) noexcept;

}  // namespace nearfit
