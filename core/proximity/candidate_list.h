#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/proximity/cull_kernel.h"
#include "core/proximity/lmd_query.h"

namespace nearfit {

/// How far a pose may move before what was found for it no longer holds.
struct MotionBudget {
  double travel = 0.0;  ///< Of any point of the part [m].
  double turn = 0.0;    ///< [rad]
};

/// The motion between two poses of a part: the farthest that a point of it can have moved, and the angle.
/// @param radius  Of a sphere about the part's centre that holds it [m].
MotionBudget motionBetween(const RigidTransform& from, const RigidTransform& to, double radius) noexcept;

/// The pairs of features that can carry a minimum at a pose, or at any other within a motion budget of it:
/// testing those alone is exact there. Room for them is allocated once.
class CandidateList {
 public:
  /// @param capacity  Pairs; about 128 bytes each.
  explicit CandidateList(std::size_t capacity);

  /// Searches both trees. Real-time safe but for its unbounded work: for a thread that can take its time.
  /// The list is unusable afterwards when there are more pairs than it has room for.
  void build(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
             double cutoff, const MotionBudget& budget, LmdScratch& scratch) noexcept;

  /// Whether the list is exact for a pose and cutoff.
  bool covers(const RigidTransform& sceneFromPart, double cutoff) const noexcept;

  /// The exact set at a pose that the list covers, as findLmds gives it. Real-time safe.
  LmdResult query(const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                  std::span<Lmd> out) const noexcept;

  std::size_t size() const noexcept { return count_; }
  /// Motion since the list was built as a fraction of its budget; above 1 where it covers no longer.
  double spent(const RigidTransform& sceneFromPart) const noexcept;

 private:
  void addPair(std::uint32_t sceneLane, std::uint32_t partLane) noexcept;

  std::vector<BoundPairs> blocks_;
  std::size_t count_ = 0;
  bool isUsable_ = false;
  const NormalConeTree *scene_ = nullptr, *part_ = nullptr;
  RigidTransform pose_;
  double cutoff_ = 0.0;
  MotionBudget budget_;
};

}  // namespace nearfit
