#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"

namespace nearfit {

/// Poses of a body that a plan may use. All poses here are of a frame whose origin is at the body's centre, in the world:
/// from one to the next the centre moves straight, while the body turns about it at a constant rate.
struct PoseBounds {
  glm::dvec3 lower{0.0}, upper{0.0};  ///< Of the centre [m]; lower < upper.
  double radius =
      1.0;  ///< Of the body about its centre [m]; > 0. A turn counts as that many metres a radian.
  bool mayTurn = true;
};

/// Motions of a body among others, as a planner asks for them. Used by one thread at a time.
class PoseMotions {
 public:
  virtual ~PoseMotions() = default;

  /// True if the body is free at a pose.
  virtual bool isFree(const RigidTransform& pose) = 0;
  /// True if it is proven that the body is free all the way from one pose to another.
  virtual bool isFree(const RigidTransform& from, const RigidTransform& to) = 0;
  /// Goes from a free pose toward another in a bounded number of steps, and slides along what is in the way. Appends the
  /// poses passed, without `from`; the motion to each is proven free. True if the last one is exactly `toward`.
  /// @param isTowed  Only the centre is drawn there; the body turns as what it slides along makes it.
  virtual bool advance(const RigidTransform& from, const RigidTransform& toward, bool isTowed,
                       std::vector<RigidTransform>& way) = 0;
  /// Told of each pose that is reached from the start. True if it counts as a goal.
  virtual bool reach(const RigidTransform& pose) = 0;
};

/// Poses that follow each other, with a free motion between each two.
using PoseWay = std::vector<RigidTransform>;

/// Question to a planner.
struct PoseQuery {
  PoseBounds bounds;
  RigidTransform start;
  std::vector<RigidTransform>
      goals;  ///< Free; may be empty for planBySliding() if PoseMotions::reach() knows goals.
  std::vector<PoseWay> startWays;      ///< Known already; each begins at the start.
  std::vector<PoseWay> goalWays;       ///< Known already; each begins at one of the goals.
  std::vector<glm::dvec3> directions;  ///< Along which the body probably moves freely; unit, at most 32.
  std::uint64_t seed = 1;
};

/// Answer of a planner.
struct PosePlan {
  PoseWay way;            ///< From the start to a goal; empty if none was found.
  std::size_t poses = 0;  ///< Number of poses that it reached, from the start and from goals.
};

/// Tells a planner to give up.
using PlanLimit = std::function<bool()>;

/// Grows two trees of poses, from the start and from the goals, by motions that slide along what is in the way
/// (PoseMotions::advance) toward random poses, along the directions given, and by random screws; and tries to connect
/// them after each. Deterministic for a seed, apart from the limit.
/// Source: Kuffner and LaValle 2000 (RRT-Connect); Zhang and Manocha 2008 (retraction of samples to contact), with
/// sliding instead of retraction. Nearest neighbours are OMPL's.
PosePlan planBySliding(const PoseQuery& query, PoseMotions& motions, const PlanLimit& isOver);

/// OMPL's RRT-Connect over SE(3), of motions that are free as a whole (PoseMotions::isFree). Needs goals. Deterministic
/// for a seed, apart from the limit. Throws std::exception if OMPL refuses the query.
PosePlan planByConnecting(const PoseQuery& query, PoseMotions& motions, const PlanLimit& isOver);

}  // namespace nearfit
