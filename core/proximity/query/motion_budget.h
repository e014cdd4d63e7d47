#pragma once

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit {

/// Motion from a pose within which a result for that pose stays valid.
struct MotionBudget {
  double travel = 0.0;  ///< Max displacement of any point of the part [m].
  double turn = 0.0;    ///< Max rotation [rad].

  bool operator==(const MotionBudget&) const = default;
};

/// Returns the motion between two poses of a part: a bound on the displacement of its points, and the angle.
/// @param radius  Radius of a sphere about the frame's origin that holds the part [m].
MotionBudget motionBetween(const RigidTransform& from, const RigidTransform& to, double radius) noexcept;

/// Returns the larger share of a budget that a motion uses; infinity if it uses any of an empty budget.
double spentShare(const MotionBudget& motion, const MotionBudget& budget) noexcept;

MotionBudget operator*(double factor, const MotionBudget& budget) noexcept;

/// Stretch of a path: poses from `shift` and `spin` before a middle pose to as far after it.
struct MotionStretch {
  glm::dvec3 shift{0.0};  ///< Translation of the part's centre [m].
  glm::dvec3 spin{0.0};   ///< Rotation vector (axis times angle) about the centre [rad].

  bool operator==(const MotionStretch&) const = default;
};

/// Returns the pose at a time on a stretch. Frames have their origin at the part's centre.
/// @param time  -1 to 1; 0 is the middle.
RigidTransform poseOn(const MotionStretch& stretch, const RigidTransform& middle, double time) noexcept;

/// Returns the approximate time at which a stretch, if it went on at both ends, would be nearest to a pose.
/// @param radius  Radius of the part about its centre [m].
double timeAlong(const MotionStretch& stretch, const RigidTransform& middle, const RigidTransform& pose,
                 double radius) noexcept;
/// The same on the stretch alone: -1 to 1.
/// @param radius  Radius of the part about its centre [m].
double nearestTime(const MotionStretch& stretch, const RigidTransform& middle, const RigidTransform& pose,
                   double radius) noexcept;

/// Range of poses: those within a budget of some pose of a stretch.
struct MotionRange {
  MotionStretch stretch;
  MotionBudget budget;

  bool operator==(const MotionRange&) const = default;
};

MotionRange operator*(double factor, const MotionRange& range) noexcept;
/// Returns the same range in a rotated frame.
MotionRange turned(const glm::dquat& turn, const MotionRange& range) noexcept;

/// Returns the share of a range that a pose uses, along the stretch or in deviation from it; above 1 it is
/// outside. Frames have their origin at the part's centre.
double spentShare(const MotionRange& range, const RigidTransform& middle, const RigidTransform& pose,
                  double radius) noexcept;

}  // namespace nearfit
