#include "core/path/sliding_motions.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"
#include "core/path/assembly_path.h"
#include "core/proximity/surface/surface_distance.h"

namespace nearfit {
namespace {

/// Max step of a slide, in radii: the program is linear, and turns by more leave what they slide along.
constexpr double kStride = 0.08;
/// Clearances that slides keep where they can, in radii, one after another. The wider, the less there is to prove; the
/// narrower, the tighter the gap that can be entered.
constexpr std::array<double, 6> kKeeps{0.01, 0.003, 0.01, 0.001, 0.003, 0.0003};
/// No clearance kept is less than this many separations: the certifier needs 17/16, and proofs need room.
constexpr double kLeastKeep = 1.5;
/// Weight of clearance against motion: low enough that a slide enters a gap narrower than twice what it keeps.
constexpr double kClearanceWeight = 8.0;
/// Radius of gyration, in radii: that of a ball.
constexpr double kGyration = 0.63;
/// Halvings of a step before it counts as blocked.
constexpr int kHalvings = 5;
/// A slide ends after this many steps in a row that gain less than this share of what is wanted.
constexpr int kPatience = 2;
constexpr double kLeastGain = 0.03;
/// Poses nearer than this share of the radius are taken for the same: rounding is far below.
constexpr double kArrived = 1e-9;
/// Bounds on the search for near points: enough for a slide, which is proven anyway.
constexpr std::size_t kMaxNear = 256;
constexpr std::uint64_t kMaxNodePairs = 20'000;
/// Bound on the distances that prove a motion: a stride at a hundredth of the usual clearance.
constexpr std::uint64_t kMaxDistances = 500;

}  // namespace

RigidTransform centrePose(const RigidTransform& worldFromLead, const glm::dvec3& centre) noexcept {
  return {worldFromLead.rotation, worldFromLead.applyToPoint(centre)};
}

RigidTransform leadPose(const RigidTransform& worldFromCentre, const glm::dvec3& centre) noexcept {
  const RigidTransform pose = worldFromCentre.normalized();
  return {pose.rotation, pose.translation - pose.rotation * centre};
}

SlidingMotions::SlidingMotions(const SlidingSpace& space, std::function<bool(const RigidTransform&)> isGoal)
    : space_(space),
      isGoal_(std::move(isGoal)),
      radius_(std::max(space.certifier.radius(), std::numeric_limits<double>::min())),
      scratch_(4 * kMaxNear),
      lmds_(kMaxNear) {}

bool SlidingMotions::isFree(const RigidTransform& pose) {
  return isFree(pose, pose);
}

bool SlidingMotions::isFree(const RigidTransform& from, const RigidTransform& to) {
  ++work_;
  const PathSegment segment{leadPose(from, space_.centre), leadPose(to, space_.centre)};
  return space_.certifier.freeSegments(std::span(&segment, 1), {}, kMaxDistances).front() != 0;
}

bool SlidingMotions::reach(const RigidTransform& pose) {
  return isGoal_ && isGoal_(pose);
}

std::vector<glm::dvec3> SlidingMotions::normalsAt(const RigidTransform& pose, double within) {
  look(pose, within);
  std::vector<glm::dvec3> normals;
  for (const NearPoints& points : near_)
    normals.push_back(points.direction);
  return normals;
}

bool SlidingMotions::advance(const RigidTransform& from, const RigidTransform& toward, bool isTowed,
                             std::vector<RigidTransform>& way) {
  const double keep = std::max(kKeeps[advances_++ % kKeeps.size()] * radius_, kLeastKeep * space_.separation);
  const double longest = std::max(kStride * radius_, 2.0 * keep);
  RigidTransform pose = from;
  double stride = longest;
  int idle = 0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const Motion wanted = wantedAt(pose, toward, isTowed);
    const double left = lengthOf(wanted);
    if (left <= kArrived * radius_) return false;
    // The last step ends exactly at the pose asked for.
    if (!isTowed && left <= stride && isFree(pose, toward)) {
      way.push_back(toward);
      return true;
    }
    look(pose, stride + 2.0 * keep);
    RigidTransform next;
    // A towed body keeps its rotation in open space.
    const RigidTransform aim = isTowed ? RigidTransform{pose.rotation, toward.translation} : toward;
    if (near_.empty() && leap(pose, aim, stride, next)) {
      pose = next;
      way.push_back(pose);
      if (!isTowed && pose == toward) return true;
      continue;
    }
    const double share = std::min(1.0, 0.95 * stride / left);
    const Motion goal{share * wanted.shift, share * wanted.turn};
    Motion taken = stepOf(goal, stride, keep);
    if (!take(pose, taken)) return false;
    way.push_back(pose);
    const double gyration = kGyration * radius_;
    const double gain =
        glm::dot(taken.shift, goal.shift) + gyration * gyration * glm::dot(taken.turn, goal.turn);
    const double whole =
        glm::dot(goal.shift, goal.shift) + gyration * gyration * glm::dot(goal.turn, goal.turn);
    idle = gain < kLeastGain * whole ? idle + 1 : 0;
    if (idle >= kPatience) return false;
    // A step that had to be halved warns of the next one.
    stride = std::min(longest, std::max(2.0 * lengthOf(taken), 0.1 * longest));
  }
  return false;
}

SlidingMotions::Motion SlidingMotions::wantedAt(const RigidTransform& pose, const RigidTransform& toward,
                                                bool isTowed) const noexcept {
  Motion wanted{toward.translation - pose.translation, glm::dvec3(0.0)};
  if (!isTowed && space_.mayTurn)
    wanted.turn = rotationVector(toward.rotation * glm::conjugate(pose.rotation));
  return wanted;
}

double SlidingMotions::lengthOf(const Motion& motion) const noexcept {
  return glm::length(motion.shift) + radius_ * glm::length(motion.turn);
}

bool SlidingMotions::leap(const RigidTransform& pose, const RigidTransform& toward, double stride,
                          RigidTransform& out) {
  double share = 1.0;
  const Motion whole = wantedAt(pose, toward, false);
  const double length = lengthOf(whole);
  while (share * length >= stride) {
    out = poseBetween(pose, toward, glm::dvec3(0.0), share);
    if (isFree(pose, out)) return true;
    share *= 0.5;
  }
  return false;
}

SlidingMotions::Motion SlidingMotions::stepOf(const Motion& wanted, double stride, double keep) {
  MassMetric metric;
  metric.gyration = glm::dvec3(kGyration * radius_);
  metric.radius = radius_;
  rows_.clear();
  for (const NearPoints& points : near_) {
    StepVector row = stepRow(points.direction, points.arm, glm::dquat(1.0, 0.0, 0.0, 0.0), metric);
    if (!space_.mayTurn) row[3] = row[4] = row[5] = 0.0;
    if (!rows_.add(row, points.distance)) break;
  }
  StepGoal goal;
  const glm::dvec3 turn = wanted.turn * metric.gyration;
  goal.wanted = {wanted.shift.x, wanted.shift.y, wanted.shift.z, turn.x, turn.y, turn.z};
  goal.cost = {2.0 * keep, kClearanceWeight, keep};
  goal.radius = radius_;
  goal.gyration = metric.gyration;
  goal.reach = stride;
  const StepSolution solution = program_.solve(rows_, goal);
  return {glm::dvec3(solution.y[0], solution.y[1], solution.y[2]),
          glm::dvec3(solution.y[3], solution.y[4], solution.y[5]) / metric.gyration};
}

bool SlidingMotions::take(RigidTransform& pose, Motion& step) {
  for (int halving = 0; halving <= kHalvings; ++halving) {
    if (!(lengthOf(step) > kArrived * radius_)) return false;
    const RigidTransform next{glm::normalize(rotationOf(step.turn) * pose.rotation),
                              pose.translation + step.shift};
    if (isFree(pose, next)) {
      pose = next;
      return true;
    }
    step.shift *= 0.5;
    step.turn *= 0.5;
  }
  return false;
}

void SlidingMotions::look(const RigidTransform& pose, double within) {
  ++work_;
  near_.clear();
  const RigidTransform worldFromLead = leadPose(pose, space_.centre);
  for (const PathPart& moving : space_.bodies.moving) {
    for (const Scene::PartPtr& other : space_.bodies.others)
      lookAt(moving, *other, worldFromLead, within);
  }
  // If not all fit into the program, the farthest are left out.
  std::ranges::sort(near_, {}, &NearPoints::distance);
}

void SlidingMotions::lookAt(const PathPart& moving, const Part& other, const RigidTransform& worldFromLead,
                            double within) {
  const PartGeometry &its = *other.geometry, &mine = *moving.part->geometry;
  const RigidTransform pose = otherFromPart(other, worldFromLead, moving);
  if (boxGap(its.mesh.bounds(), mine.mesh.bounds(), pose) > within) return;
  const NormalConeTree &scene = its.tree(), &part = mine.tree();
  const double deviation = scene.deviation() + part.deviation();
  const RigidTransform world = centrePose(worldFromLead, space_.centre);
  const LmdResult found =
      findNearestLmds(scene, part, pose, within + deviation, scratch_, lmds_, kMaxNodePairs);
  for (std::size_t i = 0; i < found.count; ++i)
    addNear(lmds_[i], other, world, deviation);
  if (found.count > 0 && its.isSolid() && mine.isSolid()) return;
  // Surfaces without an inside may be nearest where they have no minimum of one side.
  const SurfaceDistance nearest =
      leastSurfaceDistance(scene, part, pose, within + deviation, scratch_, kMaxNodePairs);
  if (!nearest.isFound || !(nearest.distance > 0.0)) return;
  Lmd lmd;
  lmd.scenePoint = nearest.scenePoint;
  lmd.partPoint = nearest.partPoint;
  lmd.distance = nearest.distance;
  lmd.direction = (nearest.partPoint - nearest.scenePoint) / nearest.distance;
  addNear(lmd, other, world, deviation);
}

void SlidingMotions::addNear(const Lmd& lmd, const Part& other, const RigidTransform& pose,
                             double deviation) {
  const glm::dvec3 direction = other.worldFromPart.applyToVector(lmd.direction);
  const glm::dvec3 middle = other.worldFromPart.applyToPoint(lmd.partPoint) - pose.translation;
  const double distance = std::max(lmd.distance - deviation, 0.0);
  if (!lmd.isRegion) {
    near_.push_back({middle, direction, distance});
    return;
  }
  // The corners of a region stop turns that its middle does not see.
  const glm::dvec3 along = other.worldFromPart.applyToVector(lmd.extent.axis);
  const glm::dvec3 across = glm::cross(direction, along);
  for (const double a : {-lmd.extent.halfLength, lmd.extent.halfLength}) {
    for (const double b : {-lmd.extent.halfWidth, lmd.extent.halfWidth})
      near_.push_back({middle + a * along + b * across, direction, distance});
  }
}

}  // namespace nearfit
