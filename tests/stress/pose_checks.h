#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tests/exact/pose_certifier.h"
#include "tests/stress/stress_scene.h"

namespace nearfit::stress {

/// Lets exact predicates decide whether the part meets a body at poses.
class PoseChecks {
 public:
  explicit PoseChecks(const StressScene& scene);

  /// A pose that follows on an equal one is the same.
  void add(const RigidTransform& worldFromPart, std::uint64_t tick);

  std::uint64_t certified() const noexcept { return certified_; }
  std::uint64_t meetings() const noexcept { return meetings_; }
  /// Tick of the first pose at which it meets something, or has changed sides.
  std::optional<std::uint64_t> firstBad() const noexcept { return firstBad_; }
  const RigidTransform& firstBadPose() const noexcept { return firstBadPose_; }

 private:
  bool isBad(const RigidTransform& worldFromPart) const;

  const StressScene& scene_;
  std::vector<test::PoseCertifier> certifiers_;  ///< By body.
  std::optional<RigidTransform> last_;
  std::uint64_t certified_ = 0, meetings_ = 0;
  std::optional<std::uint64_t> firstBad_;
  RigidTransform firstBadPose_;
};

}  // namespace nearfit::stress
