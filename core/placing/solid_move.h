#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/scene/scene.h"
#include "core/servo/proxy.h"
#include "core/servo/scene_tracker.h"

namespace nearfit {

/// Moves parts of a scene, as one rigid body, as far toward a target as the other parts allow, with the
/// servo's proxy. The parts slide along what they touch, a margin away, and never meet it.
///
/// Parts that start nearer than the margin to something may end as near if the target is there; on the way
/// they keep the margin. Parts that they overlap at the start do not block them until they have come apart.
/// Parts that are held do not move at all: a motion below a fiftieth of the margin is discarded.
///
/// A part that is moved by itself stays on its joints, or goes to them: it moves to the pose on them that is nearest to
/// the target. Parts that are moved together leave their joints alone.
///
/// A pure translation never rotates the parts, whatever they touch; a motion with rotation may also displace
/// them. There is no friction, so that placed parts slide.
///
/// Not for the servo thread; one thread at a time. A tick takes at most 1.5 ms on a slow core, usually a
/// tenth of that, plus an occasional search of the surroundings.
class SolidMove {
 public:
  /// Max ticks of a whole motion. In contact, a tick covers about twenty margins.
  static constexpr int kMaxTicks = 4000;

  /// Joins several parts into one mesh, in the frame of the first, and leaves out invisible ones. Builds missing
  /// hierarchies, which takes seconds for millions of triangles (prepareHierarchies() can do so beforehand).
  /// @param moved  Not empty.
  /// Throws UsageError if a part is not in the scene; Cancelled.
  SolidMove(const Scene& scene, std::span<const PartId> moved, const ProgressCallback& progress = {});

  struct Progress {
    bool isSettled = false;   ///< The parts go no farther toward the last target.
    bool hasArrived = false;  ///< They are exactly at the target, or where joints put it.
  };
  /// Continues for up to `ticks` ticks, or until the parts have settled.
  /// @param motion  Target: a world point p from the start should go to motion(p). Finite, unit quaternion.
  Progress advance(const RigidTransform& motion, int ticks);

  /// worldFromPart of each part, in the order given.
  const std::vector<RigidTransform>& poses() const noexcept { return poses_; }
  /// The motion from the start to the present poses, up to rounding.
  RigidTransform motion() const noexcept;
  /// The parts that hold them back now, each once.
  std::vector<PartId> touching() const;
  /// The parts that do not block them yet, because they overlapped at the start.
  std::vector<PartId> overlapping() const;

 private:
  /// The target on the joints of the part that is moved.
  RigidTransform onJoints(const RigidTransform& target, double turnScale) const noexcept;
  bool tick(const RigidTransform& target, double turnScale);
  void settle(const RigidTransform& target, double turnScale, int ticks);
  void findStartDistance();
  void keepMargin(double margin);
  void updatePoses();
  const RigidTransform& reached() const noexcept { return isHeld_ ? start_ : pose_; }
  std::vector<PartId> idsOf(const std::vector<std::uint32_t>& bodies) const;

  std::shared_ptr<const ServoScene> scene_;
  ProxySettings settings_;
  SearchReach reach_;
  SceneTracker tracker_;
  TrackedScene tracked_;
  std::unique_ptr<Proxy> proxy_;
  RigidTransform start_, pose_;  ///< Poses of the body that the parts form.
  RigidTransform wanted_;
  double margin_;  ///< Kept on the way [m].
  /// Margin kept at the end: `margin_`, or less if the parts started nearer to something [m]. 0 until known.
  double marginAtEnd_ = 0.0;
  bool isSettled_ = false;
  bool isHeld_ = false;         ///< The parts stay where they started.
  int still_ = 0, waited_ = 0;  ///< Consecutive ticks without motion; of waiting for lists.
  std::vector<RigidTransform> startPoses_, bodyFromPart_, poses_;
};

/// Moves parts like SolidMove, the whole way at once: for typed poses and alignment.
/// @param motion  As for SolidMove::advance().
/// @return worldFromPart of each part, in the order given.
/// May take seconds: not for the GUI thread. Throws what SolidMove throws, and Cancelled.
std::vector<RigidTransform> movedSolidly(const Scene& scene, std::span<const PartId> moved,
                                         const RigidTransform& motion, const ProgressCallback& progress = {});

}  // namespace nearfit
