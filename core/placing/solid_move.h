#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/haptics/proxy.h"
#include "core/haptics/scene_tracker.h"
#include "core/progress.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Moves parts of a scene, as one rigid body, as far towards where they are wanted as the others let them, by
/// the proxy that the servo feels with: they slide along what they touch, a margin away from it, and never
/// meet it. Parts that start nearer than the margin to something end as near, if they are wanted there; on
/// the way they go by the margin. What they overlap where they start lets them through until they have come
/// apart. Held where they stand they do not move at all: what goes less than a fiftieth of the margin stays.
///
/// A motion that only shifts does not turn them, whatever they touch; one that turns may shift them aside.
/// There is no friction: what is placed by hand is to slide.
///
/// Not for the servo thread, and for one thread at a time. A tick takes 1.5 ms at most on a slow core, in
/// most cases a tenth of that, and now and then a search of the surroundings beside it.
class SolidMove {
 public:
  /// Of a whole way at once. In contact a tick goes some twenty margins.
  static constexpr int kMostTicks = 4000;

  /// As makePlacingScene(), and throws what that does.
  SolidMove(const Scene& scene, std::span<const PartId> moved, const ProgressCallback& progress = {});

  struct Progress {
    bool isSettled = false;   ///< They go no farther towards what was wanted last.
    bool hasArrived = false;  ///< They are where they were wanted, to the last bit.
  };
  /// Goes on from where they are for so many ticks, or until they have settled.
  /// @param motion  What stood at a point p of the world at the start is wanted at motion(p); finite, its
  ///                quaternion unit.
  Progress advance(const RigidTransform& motion, int ticks);

  /// Of each part, in the order given: worldFromPart.
  const std::vector<RigidTransform>& poses() const noexcept { return poses_; }
  /// The motion that has brought them from the start to where they are, but for rounding.
  RigidTransform motion() const noexcept;
  /// What holds them back now, each part once.
  std::vector<PartId> touching() const;
  /// What lets them through, as they overlapped it at the start.
  std::vector<PartId> released() const;

 private:
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
  RigidTransform start_, pose_;  ///< Of the body that they are one of.
  RigidTransform wanted_;
  double margin_;  ///< That is kept on the way [m].
  /// What the parts keep where they end: at most the margin, less where they were nearer at the start [m]. 0:
  /// not known yet.
  double marginAtEnd_ = 0.0;
  bool isSettled_ = false;
  bool isHeld_ = false;         ///< Where they started.
  int still_ = 0, waited_ = 0;  ///< Ticks since the parts last moved, or since the proxy knew enough.
  std::vector<RigidTransform> startPoses_, bodyFromPart_, poses_;
};

/// Where parts come to that are moved so, the whole way at once: for numbers and alignment.
/// @param motion  As for SolidMove::advance.
/// @return worldFromPart of each part, in the order given.
/// Takes what it takes: off the GUI thread. Throws what SolidMove does.
std::vector<RigidTransform> movedSolidly(const Scene& scene, std::span<const PartId> moved,
                                         const RigidTransform& motion, const ProgressCallback& progress = {});

}  // namespace nearfit
