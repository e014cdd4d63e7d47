#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "core/haptics/locked_motions.h"
#include "core/haptics/mass_metric.h"
#include "core/math/rigid_transform.h"
#include "core/scene/joint.h"
#include "core/scene/scene.h"

namespace nearfit {

/// How far a pose is off joints: the most over them.
struct JointResidual {
  double distance = 0.0;  ///< Of the part's point from the axis, plane or point of the base [m].
  double angle = 0.0;     ///< Of the part's direction from the one that it should have [rad].
};

/// The joints of one part, as they are in the world while their bases stand still. A value without allocation; all
/// members are real-time safe.
///
/// The sense in which an axis of the part stays on its base's is that of the pose that the set was made at.
class JointSet {
 public:
  /// A joint in the world.
  struct Placed {
    JointKind kind = JointKind::OnAxis;
    JointFeature onPart;               ///< In the part's frame.
    glm::dvec3 place{0.0};             ///< On the axis or in the plane, or the point, in the world [m].
    glm::dvec3 target{0.0, 0.0, 1.0};  ///< Direction that the part's should have, in the world; unit.
  };

  /// Joints on features that were picked on meshes fit together only so well. Those that fit to within this hold, the
  /// older exactly; those that do not contradict each other. A tenth of a usual margin [m], and what that is over a
  /// tenth of a metre [rad].
  static constexpr double kMaxMisfit = 1e-5, kMaxMisfitAngle = 1e-4;
  /// A pose whose correction is at most this share of the lengths involved, some roundings, is on the joints.
  static constexpr double kRounding = 1e-14;

  JointSet() = default;
  /// @param joints         At most kMaxJointsPerPart; directions are unit. The sense of axes is chosen here.
  /// @param worldFromPart  Where the part is, on the joints or off them.
  JointSet(std::span<const Placed> joints, const RigidTransform& worldFromPart) noexcept;

  bool isEmpty() const noexcept { return count_ == 0; }
  std::size_t size() const noexcept { return count_; }
  /// True if no pose was found that fulfils all joints. Such joints hold nothing.
  bool isContradictory() const noexcept { return isContradictory_; }

  /// The pose on the joints that the least motion leads to. For one joint that is the least rotation, about the point of
  /// its axis or plane that is nearest to the centre, and then the least translation, exactly. For several it is the
  /// least motion with rotations weighed by the farthest feature's distance, found step by step. Joints that
  /// contradict each other leave the pose as it is, and so do poses on the joints, to the last bit.
  /// @param worldFromPart  Finite, unit quaternion.
  /// @param centreInPart   Centre of mass [m].
  RigidTransform nearestPose(const RigidTransform& worldFromPart,
                             const glm::dvec3& centreInPart) const noexcept;
  /// The same with the least motion in a metric of mass: the pose on the joints at which a coupling in that metric holds
  /// the least energy, so that it does not pull along them. The work is bounded by kMaxWork.
  RigidTransform nearestPose(const RigidTransform& worldFromPart, const glm::dvec3& centreInPart,
                             const MassMetric& metric) const noexcept;

  /// A pose on the joints near one that is nearly on them: by the correction alone, which for one joint is exact.
  /// std::nullopt if none was found, or the joints contradict each other.
  std::optional<RigidTransform> correctedPose(const RigidTransform& worldFromPart,
                                              const glm::dvec3& centreInPart,
                                              const MassMetric& metric) const noexcept;

  /// How far the pose is off the joints, also of those that contradict each other.
  JointResidual residual(const RigidTransform& worldFromPart) const noexcept;

  /// The motions that the joints lock at a pose, and the step back to the joints; none if they contradict each other.
  LockedMotions lockedMotions(const RigidTransform& worldFromPart, const glm::dvec3& centreInPart,
                              const MassMetric& metric) const noexcept;

  /// The part of a translation that the joints allow [m].
  glm::dvec3 freeShift(const glm::dvec3& shift) const noexcept;

 private:
  /// Max corrections until a pose is on several joints: a few reach rounding from poses that are near. More for the first
  /// such pose, which may be far from where the part is.
  static constexpr int kMaxCorrections = 12, kMaxFirstCorrections = 60;
  /// Where rounding keeps corrections from ending, this share of the lengths involved will do.
  static constexpr double kConverged = 1e-10;
  /// Max steps along the joints toward the nearest pose, and max halvings of one that leads away.
  static constexpr int kMaxRefinements = 12, kMaxHalvings = 4;
  /// Max corrections of several joints in a search for the nearest pose, some 1 us each.
  static constexpr int kMaxWork = 64;
  /// A pull along the joints below this share of the whole ends the search.
  static constexpr double kRefined = 1e-9;

  std::span<const Placed> joints() const noexcept { return {joints_.data(), count_}; }
  MassMetric plainMetric(const glm::dvec3& centreInPart) const noexcept;
  /// The correction's length as a share of the lengths involved; infinite beyond the misfit allowed.
  double lack(const RigidTransform& pose, const glm::dvec3& centreInPart,
              const MassMetric& metric) const noexcept;
  bool isOn(const RigidTransform& pose, const glm::dvec3& centreInPart,
            const MassMetric& metric) const noexcept {
    return lack(pose, centreInPart, metric) <= kRounding;
  }
  /// correctedPose() in at most `most` corrections, which are counted down.
  std::optional<RigidTransform> corrected(const RigidTransform& worldFromPart, const glm::dvec3& centreInPart,
                                          const MassMetric& metric, int& most) const noexcept;
  RigidTransform nearest(const RigidTransform& wanted, const glm::dvec3& centreInPart,
                         const MassMetric& metric) const noexcept;
  bool findAnchor(const RigidTransform& start) noexcept;

  std::array<Placed, kMaxJointsPerPart> joints_{};
  std::size_t count_ = 0;
  bool isContradictory_ = false;
  RigidTransform anchor_;  ///< A pose on several joints.
};

/// A joint with its base where the scene has it.
JointSet::Placed placedInWorld(const Scene& scene, const Joint& joint);
/// The joints of a part that are on, with their bases where the scene has them. Throws UsageError if there is no such
/// part.
JointSet jointsOf(const Scene& scene, PartId part);

}  // namespace nearfit
