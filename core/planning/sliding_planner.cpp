#include <algorithm>
#include <cmath>
#include <deque>
#include <iostream>  // For OMPL's header, which leaves it out.
#include <utility>

#include <glm/geometric.hpp>
#include <ompl/datastructures/NearestNeighborsGNATNoThreadSafety.h>

#include "core/math/rotation_vector.h"
#include "core/planning/pose_planner.h"
#include "core/planning/pose_sampler.h"

namespace nearfit {
namespace {

/// Shares of the motions that are tried: toward a random pose, toward a pose of the other tree, along a direction; the
/// rest are screws. A narrow way is left along a direction or by a screw; the others cross open space.
constexpr double kUniform = 0.3, kTowardOther = 0.15, kAlong = 0.3;
/// Share of random ones among directions: those given may all be blocked.
constexpr double kRandomDirection = 0.3;
/// Max angle of a screw [rad].
constexpr double kMaxScrew = 1.6;
/// Max times that a tree is drawn on toward one pose of the other: in open space one is enough.
constexpr int kMaxConnections = 8;
/// Bits of PoseNode::along.
constexpr std::size_t kMaxDirections = 32;

/// A pose of a tree.
struct PoseNode {
  RigidTransform pose;
  const PoseNode* parent = nullptr;
  std::uint32_t along = 0;  ///< Directions that have been tried from here, as bits.
};

double distanceBetween(const RigidTransform& a, const RigidTransform& b, double radius) {
  return glm::distance(a.translation, b.translation) +
         radius * glm::length(rotationVector(glm::conjugate(a.rotation) * b.rotation));
}

class PoseTree {
 public:
  explicit PoseTree(double radius) {
    nearest_.setDistanceFunction(
        [radius](const PoseNode* a, const PoseNode* b) { return distanceBetween(a->pose, b->pose, radius); });
  }

  PoseNode* add(const RigidTransform& pose, const PoseNode* parent) {
    nodes_.push_back({pose, parent, 0});
    nearest_.add(&nodes_.back());
    return &nodes_.back();
  }
  /// Adds a way from a node; returns its last node, which is `from` if the way is empty.
  PoseNode* add(const PoseWay& way, PoseNode* from) {
    PoseNode* last = from;
    for (const RigidTransform& pose : way)
      last = add(pose, last);
    return last;
  }
  bool isEmpty() const { return nodes_.empty(); }
  std::size_t size() const { return nodes_.size(); }
  PoseNode* nearestTo(const RigidTransform& pose) const {
    PoseNode probe{pose, nullptr, 0};
    return nearest_.nearest(&probe);
  }
  PoseNode* node(std::size_t i) { return &nodes_[i]; }

 private:
  std::deque<PoseNode> nodes_;  ///< Keeps addresses.
  ompl::NearestNeighborsGNATNoThreadSafety<PoseNode*> nearest_;
};

/// From the root to a node.
PoseWay wayTo(const PoseNode* node) {
  PoseWay way;
  for (; node != nullptr; node = node->parent)
    way.push_back(node->pose);
  std::ranges::reverse(way);
  return way;
}

class SlidingPlanner {
 public:
  SlidingPlanner(const PoseQuery& query, PoseMotions& motions)
      : query_(query),
        motions_(motions),
        sampler_(query.seed),
        fromStart_(query.bounds.radius),
        fromGoal_(query.bounds.radius) {}

  PosePlan plan(const PlanLimit& isOver) {
    if (addKnown()) return found();
    bool isForward = true;
    while (!isOver()) {
      PoseTree &tree = isForward ? fromStart_ : fromGoal_, &other = isForward ? fromGoal_ : fromStart_;
      if (grow(tree, other, isForward)) return found();
      isForward = fromGoal_.isEmpty() || !isForward;
    }
    return {{}, fromStart_.size() + fromGoal_.size()};
  }

 private:
  /// A motion to try.
  struct Pull {
    PoseNode* from = nullptr;
    RigidTransform toward;
    bool isTowed = false;
  };

  /// True if a goal is among what is known.
  bool addKnown() {
    PoseNode* start = fromStart_.add(query_.start, nullptr);
    if (isGoal(start)) return true;
    for (const PoseWay& way : query_.startWays) {
      if (!way.empty() && addReached({way.begin() + 1, way.end()}, start)) return true;
    }
    for (const RigidTransform& goal : query_.goals)
      fromGoal_.add(goal, nullptr);
    for (const PoseWay& way : query_.goalWays) {
      if (way.empty()) continue;
      PoseNode* root = fromGoal_.nearestTo(way.front());
      fromGoal_.add({way.begin() + 1, way.end()}, root);
    }
    return false;
  }
  bool isGoal(const PoseNode* node) {
    if (!motions_.reach(node->pose)) return false;
    way_ = wayTo(node);
    return true;
  }
  /// Adds a way to the tree from the start; true if it passes a goal.
  bool addReached(const PoseWay& way, PoseNode* from) {
    for (const RigidTransform& pose : way) {
      from = fromStart_.add(pose, from);
      if (isGoal(from)) return true;
    }
    last_ = from;
    return false;
  }

  /// True if the trees are connected, or a goal is reached.
  bool grow(PoseTree& tree, PoseTree& other, bool isForward) {
    const Pull pull = nextPull(tree, other);
    PoseWay way;
    motions_.advance(pull.from->pose, pull.toward, pull.isTowed, way);
    if (way.empty()) return false;
    if (isForward && addReached(way, pull.from)) return true;
    const PoseNode* grown = isForward ? last_ : tree.add(way, pull.from);
    if (other.isEmpty()) return false;
    PoseNode* end = other.nearestTo(grown->pose);
    for (int i = 0; i < kMaxConnections; ++i) {
      way.clear();
      const bool isConnected = motions_.advance(end->pose, grown->pose, false, way);
      if (!isForward && addReached(way, end)) return true;
      PoseNode* next = isForward ? other.add(way, end) : last_;
      if (isConnected) {
        join(isForward ? grown : next, isForward ? next : grown);
        return true;
      }
      if (way.empty()) return false;
      end = next;
    }
    return false;
  }

  Pull nextPull(PoseTree& tree, PoseTree& other) {
    const double choice = sampler_.share();
    if (choice < kTowardOther && !other.isEmpty()) {
      const RigidTransform toward = recent(other)->pose;
      return {tree.nearestTo(toward), toward, false};
    }
    if (choice < kTowardOther + kUniform) {
      const RigidTransform toward = sampler_.pose(query_.bounds, query_.start.rotation);
      return {tree.nearestTo(toward), toward, false};
    }
    PoseNode* from = recent(tree);
    return choice < kTowardOther + kUniform + kAlong ? alongDirection(from) : screwed(from);
  }

  /// A random node; those added late, at the fringe, more often.
  PoseNode* recent(PoseTree& tree) {
    const double share = sampler_.share();
    const auto back = static_cast<std::size_t>(share * share * static_cast<double>(tree.size()));
    return tree.node(tree.size() - 1 - std::min(back, tree.size() - 1));
  }

  Pull alongDirection(PoseNode* from) {
    const std::size_t count = std::min(query_.directions.size(), kMaxDirections);
    glm::dvec3 direction = sampler_.direction();
    if (count > 0 && sampler_.share() >= kRandomDirection) {
      const std::size_t i = sampler_.index(count);
      // From one pose it would always go the same way.
      const std::uint32_t bit = 1U << i;
      if ((from->along & bit) == 0) direction = query_.directions[i];
      from->along |= bit;
    }
    const double length = glm::distance(query_.bounds.lower, query_.bounds.upper);
    return {from, {from->pose.rotation, from->pose.translation + length * direction}, true};
  }

  /// A turn about a random axis near the body, with a shift along it.
  Pull screwed(PoseNode* from) {
    const double radius = query_.bounds.radius;
    const glm::dvec3 axis = sampler_.direction();
    const glm::dvec3 shift = sampler_.between(-radius, radius) * axis;
    const glm::dvec3 arm = sampler_.between(0.0, radius) * sampler_.direction();
    RigidTransform toward = from->pose;
    if (query_.bounds.mayTurn) {
      const glm::dquat turn = rotationOf(sampler_.between(-kMaxScrew, kMaxScrew) * axis);
      toward.rotation = glm::normalize(turn * from->pose.rotation);
      toward.translation += arm - turn * arm;
    } else {
      toward.translation += arm;
    }
    toward.translation += shift;
    return {from, toward, false};
  }

  void join(const PoseNode* start, const PoseNode* goal) {
    way_ = wayTo(start);
    // Both nodes have the same pose.
    for (const PoseNode* node = goal->parent; node != nullptr; node = node->parent)
      way_.push_back(node->pose);
  }
  PosePlan found() { return {std::move(way_), fromStart_.size() + fromGoal_.size()}; }

  const PoseQuery& query_;
  PoseMotions& motions_;
  PoseSampler sampler_;
  PoseTree fromStart_, fromGoal_;
  PoseNode* last_ = nullptr;  ///< Of the way added last to the tree from the start.
  PoseWay way_;
};

}  // namespace

PosePlan planBySliding(const PoseQuery& query, PoseMotions& motions, const PlanLimit& isOver) {
  return SlidingPlanner(query, motions).plan(isOver);
}

}  // namespace nearfit
