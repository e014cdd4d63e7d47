#include <memory>

#include <glm/geometric.hpp>
#include <ompl/base/MotionValidator.h>
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/StateValidityChecker.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/base/spaces/SE3StateSpace.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/util/Console.h>

#include "core/planning/pose_planner.h"
#include "core/planning/pose_sampler.h"

namespace nearfit {
namespace {

namespace ob = ompl::base;
namespace og = ompl::geometric;

using PoseState = ob::SE3StateSpace::StateType;

/// Length of a motion that is added to a tree, in radii of the body: longer ones are seldom free in a narrow way.
constexpr double kRangeInRadii = 0.2;

RigidTransform poseOfState(const ob::State* state) {
  const auto* pose = state->as<PoseState>();
  const auto& q = pose->rotation();
  return RigidTransform{glm::dquat(q.w, q.x, q.y, q.z), glm::dvec3(pose->getX(), pose->getY(), pose->getZ())}
      .normalized();
}

void setState(ob::State* state, const RigidTransform& pose) {
  auto* to = state->as<PoseState>();
  to->setXYZ(pose.translation.x, pose.translation.y, pose.translation.z);
  auto& q = to->rotation();
  q.w = pose.rotation.w;
  q.x = pose.rotation.x;
  q.y = pose.rotation.y;
  q.z = pose.rotation.z;
}

/// OMPL's own generators are seeded once for the whole process.
class SeededStates : public ob::StateSampler {
 public:
  SeededStates(const ob::StateSpace* space, const PoseQuery& query)
      : StateSampler(space), query_(query), sampler_(query.seed) {}

  void sampleUniform(ob::State* state) override {
    setState(state, sampler_.pose(query_.bounds, query_.start.rotation));
  }
  void sampleUniformNear(ob::State* state, const ob::State* near, double distance) override {
    RigidTransform pose = poseOfState(near);
    pose.translation += sampler_.between(0.0, distance) * sampler_.direction();
    setState(state, pose);
  }
  void sampleGaussian(ob::State* state, const ob::State* mean, double deviation) override {
    sampleUniformNear(state, mean, deviation);
  }

 private:
  const PoseQuery& query_;
  PoseSampler sampler_;
};

class FreeStates : public ob::StateValidityChecker {
 public:
  FreeStates(const ob::SpaceInformationPtr& space, PoseMotions& motions)
      : StateValidityChecker(space), motions_(motions) {}
  bool isValid(const ob::State* state) const override { return motions_.isFree(poseOfState(state)); }

 private:
  PoseMotions& motions_;
};

class FreeMotions : public ob::MotionValidator {
 public:
  FreeMotions(const ob::SpaceInformationPtr& space, PoseMotions& motions)
      : MotionValidator(space), motions_(motions) {}

  bool checkMotion(const ob::State* from, const ob::State* to) const override {
    const bool isFree = motions_.isFree(poseOfState(from), poseOfState(to));
    ++(isFree ? valid_ : invalid_);
    return isFree;
  }
  bool checkMotion(const ob::State* from, const ob::State* to,
                   std::pair<ob::State*, double>& lastValid) const override {
    if (checkMotion(from, to)) return true;
    if (lastValid.first != nullptr) si_->copyState(lastValid.first, from);
    lastValid.second = 0.0;
    return false;
  }

 private:
  PoseMotions& motions_;
};

ob::StateSpacePtr stateSpace(const PoseQuery& query) {
  auto space = std::make_shared<ob::SE3StateSpace>();
  ob::RealVectorBounds bounds(3);
  for (unsigned axis = 0; axis < 3; ++axis) {
    bounds.setLow(axis, query.bounds.lower[static_cast<glm::length_t>(axis)]);
    bounds.setHigh(axis, query.bounds.upper[static_cast<glm::length_t>(axis)]);
  }
  space->setBounds(bounds);
  // Distances of rotations are half their angles there.
  space->setSubspaceWeight(1, 2.0 * query.bounds.radius);
  space->setStateSamplerAllocator(
      [&query](const ob::StateSpace* of) { return std::make_shared<SeededStates>(of, query); });
  return space;
}

}  // namespace

PosePlan planByConnecting(const PoseQuery& query, PoseMotions& motions, const PlanLimit& isOver) {
  // It would write to stdout.
  ompl::msg::noOutputHandler();
  const auto information = std::make_shared<ob::SpaceInformation>(stateSpace(query));
  information->setStateValidityChecker(std::make_shared<FreeStates>(information, motions));
  information->setMotionValidator(std::make_shared<FreeMotions>(information, motions));
  information->setup();

  const auto problem = std::make_shared<ob::ProblemDefinition>(information);
  ob::State* state = information->allocState();
  setState(state, query.start);
  problem->addStartState(state);
  const auto goals = std::make_shared<ob::GoalStates>(information);
  for (const RigidTransform& goal : query.goals) {
    setState(state, goal);
    goals->addState(state);
  }
  information->freeState(state);
  problem->setGoal(goals);

  og::RRTConnect planner(information);
  planner.setRange(kRangeInRadii * query.bounds.radius);
  planner.setProblemDefinition(problem);
  planner.setup();
  planner.solve(ob::PlannerTerminationCondition([&isOver] { return isOver(); }));
  PosePlan plan;
  ob::PlannerData data(information);
  planner.getPlannerData(data);
  plan.poses = data.numVertices();
  if (!problem->hasExactSolution()) return plan;
  const auto* path = problem->getSolutionPath()->as<og::PathGeometric>();
  for (std::size_t i = 0; i < path->getStateCount(); ++i)
    plan.way.push_back(poseOfState(path->getState(static_cast<unsigned>(i))));
  return plan;
}

}  // namespace nearfit
