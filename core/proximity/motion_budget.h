#pragma once

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit {

/// How far a pose may move before what was found for it no longer holds.
struct MotionBudget {
  double travel = 0.0;  ///< Of any point of the part [m].
  double turn = 0.0;    ///< [rad]
};

/// The motion between two poses of a part: the farthest that a point of it can have moved, and the angle.
/// @param radius  Of a sphere about the frame's origin that holds the part [m].
MotionBudget motionBetween(const RigidTransform& from, const RigidTransform& to, double radius) noexcept;

/// The larger share of a budget that a motion has spent; infinite where nothing was to be spent.
double spentShare(const MotionBudget& motion, const MotionBudget& budget) noexcept;

MotionBudget operator*(double factor, const MotionBudget& budget) noexcept;

/// A stretch of a way: poses from `shift` and `spin` before a middle one to as far after it.
struct MotionStretch {
  glm::dvec3 shift{0.0};  ///< Of the part's centre [m].
  glm::dvec3 spin{0.0};   ///< Axis times angle, about the centre [rad].
};

/// The pose at a time on a stretch. Frames have their origin in the part's centre.
/// @param time  -1 to 1; 0 is the middle.
RigidTransform poseOn(const MotionStretch& stretch, const RigidTransform& middle, double time) noexcept;

/// The time, -1 to 1, at which a stretch comes nearest to a pose, about.
double nearestTime(const MotionStretch& stretch, const RigidTransform& middle, const RigidTransform& pose,
                   double radius) noexcept;

/// Poses for which something is to hold: those within a budget of some pose of a stretch.
struct MotionRange {
  MotionStretch stretch;
  MotionBudget budget;
};

MotionRange operator*(double factor, const MotionRange& range) noexcept;
/// The same range in a frame that is turned.
MotionRange turned(const glm::dquat& turn, const MotionRange& range) noexcept;

/// Share of a range that a pose has spent, along the stretch or aside of it; above 1 it is outside. Frames
/// have their origin in the part's centre.
double spentShare(const MotionRange& range, const RigidTransform& middle, const RigidTransform& pose,
                  double radius) noexcept;

}  // namespace nearfit
