#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/haptics/step_program.h"
#include "core/path/path_bodies.h"
#include "core/path/path_certifier.h"
#include "core/planning/pose_planner.h"
#include "core/proximity/query/lmd_query.h"

namespace nearfit {

/// Bodies that slide among others, and how they may move.
struct SlidingSpace {
  const PathBodies& bodies;
  const PathCertifier& certifier;  ///< Of the same bodies.
  glm::dvec3 centre;               ///< Of the path, in the frame of the part that leads [m].
  double separation;               ///< That of the certifier [m].
  bool mayTurn;
};

/// Pose of a frame at a path's centre, in which planners think, from that of the part that leads; and back. Unit
/// quaternions.
RigidTransform centrePose(const RigidTransform& worldFromLead, const glm::dvec3& centre) noexcept;
RigidTransform leadPose(const RigidTransform& worldFromCentre, const glm::dvec3& centre) noexcept;

/// Motions of the parts of a path among all others: what planners ask for. Every motion is proven by the certifier;
/// steps that slide come from the program that moves the servo's proxy, in a metric that weighs a turn by the parts'
/// size. For one thread.
class SlidingMotions final : public PoseMotions {
 public:
  /// Max steps of advance().
  static constexpr int kMaxSteps = 16;

  /// @param space   Kept by reference, with what it refers to.
  /// @param isGoal  True for poses of the centre that reach() takes for goals; may be empty.
  SlidingMotions(const SlidingSpace& space, std::function<bool(const RigidTransform&)> isGoal);

  bool isFree(const RigidTransform& pose) override;
  bool isFree(const RigidTransform& from, const RigidTransform& to) override;
  bool advance(const RigidTransform& from, const RigidTransform& toward, bool isTowed,
               std::vector<RigidTransform>& way) override;
  bool reach(const RigidTransform& pose) override;

  /// Motions and surroundings looked at so far: a measure of time that is the same on every machine.
  std::uint64_t work() const noexcept { return work_; }
  /// Directions from other parts to near points of the moving ones at a pose; unit, in the world.
  std::vector<glm::dvec3> normalsAt(const RigidTransform& pose, double within);

 private:
  /// A small motion: shift of the centre [m], and turn about it [rad]; world frame.
  struct Motion {
    glm::dvec3 shift{0.0}, turn{0.0};
  };
  /// Points of two parts that are near each other; world frame.
  struct NearPoints {
    glm::dvec3 arm;        ///< From the centre to the moving part's [m].
    glm::dvec3 direction;  ///< From the other part to it; unit.
    double distance;       ///< [m]
  };

  void look(const RigidTransform& pose, double within);
  void lookAt(const PathPart& moving, const Part& other, const RigidTransform& pose, double within);
  void addNear(const Lmd& lmd, const Part& other, const RigidTransform& pose, double deviation);
  /// Length of a motion: no point moves farther [m].
  double lengthOf(const Motion& motion) const noexcept;
  Motion wantedAt(const RigidTransform& pose, const RigidTransform& toward, bool isTowed) const noexcept;
  /// The step nearest to the wanted motion that what is near allows.
  Motion stepOf(const Motion& wanted, double stride, double keep);
  /// Takes as much of a step as is proven free; false if nothing of it is.
  bool take(RigidTransform& pose, Motion& step);
  /// The largest of 1, 1/2, 1/4... of the way that is free; false if less than a stride is.
  bool leap(const RigidTransform& pose, const RigidTransform& toward, double stride, RigidTransform& out);

  const SlidingSpace& space_;
  std::function<bool(const RigidTransform&)> isGoal_;
  double radius_;
  LmdScratch scratch_;
  std::vector<Lmd> lmds_;
  std::vector<NearPoints> near_;
  StepRows rows_;
  StepProgram program_;
  std::uint64_t work_ = 0, advances_ = 0;
};

}  // namespace nearfit
