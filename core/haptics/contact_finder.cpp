#include "core/haptics/contact_finder.h"

#include <algorithm>
#include <optional>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// How far around a pose pairs are gathered, in reaches: a few steps of the proxy; more when a hand is fast.
constexpr double kLeastSlack = 0.5, kMostSlack = 6.0;
/// Farther turned, nearly every pair of features is a candidate [rad].
constexpr double kMostTurn = 0.1;
/// A pair of nodes leads to so many pairs of triangles, about, where surfaces are near.
constexpr std::uint64_t kTrianglesOfNode = 8;
/// Beyond so many pairs, testing those that only the room for motion adds costs more than gathering again.
constexpr std::size_t kManyPairs = 2048;
/// After so many with less room, more is tried.
constexpr unsigned kGatheringsBetweenTries = 16;

ContactPair inWorld(const ContactPair& pair, const RigidTransform& worldFromBody) noexcept {
  return {worldFromBody.applyToPoint(pair.point), worldFromBody.applyToVector(pair.direction), pair.distance};
}

/// Motion of the part between two poses, about its centre of mass.
MotionBudget motionOf(const ServoScene& scene, const RigidTransform& from,
                      const RigidTransform& to) noexcept {
  const auto centred = [&](const RigidTransform& pose) {
    return RigidTransform{pose.rotation, pose.applyToPoint(scene.centreInPart)};
  };
  return motionBetween(centred(from), centred(to), scene.metric.radius);
}

}  // namespace

// Contacts need none of the room that minima are merged in.
ContactFinder::ContactFinder()
    : scratch_(1),
      found_(ContactThinning::kMaxTaken),
      surfaceFound_(kMaxContacts),
      pairs_(std::size_t{1} << 17U) {}

void ContactFinder::beginTick() noexcept {
  workLeft_ = kMaxWork;
  searchWorkLeft_ = kMaxSearchWork;
  lateBodies_ = 0;
}

bool ContactFinder::holdsFor(const ServoScene& scene, const RigidTransform& worldFromPart,
                             double reach) const noexcept {
  return isHoldingPairs_ && reach == pairsReach_ &&
         spentShare(motionOf(scene, pairsPose_, worldFromPart), holds_) <= 1.0;
}

bool ContactFinder::gatherOne(const TrackedScene& tracked, std::uint32_t body,
                              const TrackedScene::Near* known, const RigidTransform& worldFromPart,
                              const MotionBudget& slack) noexcept {
  if (tracked.clearance.overlaps(body)) return true;
  if (bodyCount_ == kMaxBodies) return false;
  const ServoScene& scene = *tracked.scene;
  const ServoScene::Body& other = scene.bodies[body];
  if (other.surface) {
    // Looked at anew at each pose.
    bodies_[bodyCount_] = {body, nextPair(), 0};
    ++bodyCount_;
    return true;
  }
  const ContactReach within{pairsReach_, contactTurn(pairsReach_, scene.metric.radius)};
  const RigidTransform bodyFromPart = (other.worldFromPart.inverse() * worldFromPart).normalized();
  const std::size_t first = nextPair();
  const std::span<LeafPair> room = std::span(pairs_).subspan(first);
  std::optional<NearbyPairs> nearby;
  if (known != nullptr && known->contacts)
    nearby = known->contacts->nearbyPairs(bodyFromPart, within, slack, scratch_, room);
  if (!nearby) {
    ++lateBodies_;
    nearby =
        findNearbyPairs({other.geometry->tree(), scene.moving.geometry->tree(), bodyFromPart, pairsReach_},
                        within, slack, scratch_, room, searchWorkLeft_);
    searchWorkLeft_ -= std::min(searchWorkLeft_, nearby->work);
  }
  spend(nearby->work + nearby->count);
  bodies_[bodyCount_++] = {body, first, nearby->count};
  holds_ = {std::min(holds_.travel, nearby->holds.travel), std::min(holds_.turn, nearby->holds.turn)};
  return nearby->isComplete;
}

bool ContactFinder::gatherPairs(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                                double reach, double way) noexcept {
  const double radius = tracked.scene->metric.radius;
  const std::array<double, 3> rooms{std::clamp(way, kLeastSlack * reach, kMostSlack * reach),
                                    kLeastSlack * reach, 0.0};
  // Where there were many pairs there still are, most likely.
  if (roomLevel_ > 0 && ++gatherings_ % kGatheringsBetweenTries == 0) --roomLevel_;
  for (; roomLevel_ < rooms.size(); ++roomLevel_) {
    const double travel = rooms[roomLevel_];
    if (!gatherWithin(tracked, worldFromPart, reach, {travel, std::min(travel / radius, kMostTurn)}))
      continue;
    if (nextPair() <= kManyPairs || roomLevel_ + 1 == rooms.size() || lateBodies_ > 0) return true;
  }
  roomLevel_ = rooms.size() - 1;
  return false;
}

bool ContactFinder::gatherWithin(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                                 double reach, const MotionBudget& slack) noexcept {
  bodyCount_ = 0;
  pairsPose_ = worldFromPart;
  pairsReach_ = reach;
  holds_ = slack;
  bool isComplete = true;
  const double far = reach + slack.travel;
  const double spent = tracked.spent(worldFromPart, far);
  // What is said not to be near is so within what is left of the budget.
  if (spent <= 1.0) {
    const MotionBudget left = (1.0 - spent) * tracked.clear;
    holds_ = {std::min(holds_.travel, left.travel), std::min(holds_.turn, left.turn)};
  }
  tracked.visitNear(worldFromPart, far, [&](std::uint32_t body, const TrackedScene::Near* known) {
    isComplete = isComplete && gatherOne(tracked, body, known, worldFromPart, slack);
  });
  isHoldingPairs_ = isComplete;
  return isComplete;
}

std::size_t ContactFinder::nextPair() const noexcept {
  return bodyCount_ == 0 ? 0 : bodies_[bodyCount_ - 1].first + bodies_[bodyCount_ - 1].count;
}

void ContactFinder::testPairs(const ServoScene& scene, const HeldBody& held,
                              const RigidTransform& worldFromPart, Surroundings& around) noexcept {
  const ServoScene::Body& other = scene.bodies[held.body];
  const ContactReach within{pairsReach_, contactTurn(pairsReach_, scene.metric.radius)};
  const RigidTransform bodyFromPart = (other.worldFromPart.inverse() * worldFromPart).normalized();
  const ContactResult result =
      testContacts({other.geometry->tree(), scene.moving.geometry->tree(), bodyFromPart, pairsReach_}, within,
                   std::span<const LeafPair>(pairs_).subspan(held.first, held.count), found_);
  spend(result.leafPairs);
  around.distance = std::min(around.distance, result.distanceBound());
  around.completeTo = std::min(around.completeTo, result.completeTo);
  for (const ContactPair& pair : std::span(found_).first(result.count)) {
    if (!thinning_.add({inWorld(pair, other.worldFromPart), held.body})) around.completeTo = 0.0;
  }
}

void ContactFinder::testSurface(const ServoScene& scene, const HeldBody& held,
                                const RigidTransform& worldFromPart, Surroundings& around) noexcept {
  const ServoScene::Body& other = scene.bodies[held.body];
  const RigidTransform bodyFromPart = (other.worldFromPart.inverse() * worldFromPart).normalized();
  const SurfaceContacts result =
      findSurfaceContacts(*other.surface, *scene.moving.surface, bodyFromPart, pairsReach_, scratch_,
                          surfaceFound_, workLeft_ / kTrianglesOfNode);
  spend(result.nodePairs + result.trianglePairs);
  around.distance = std::min(around.distance, result.lowerBound);
  if (!result.isComplete) {
    const double farthest = result.count > 0 ? surfaceFound_[result.count - 1].distance : 0.0;
    // Where it was full the nearest are there, else what was looked at first.
    const bool isFull = result.count == surfaceFound_.size();
    around.completeTo = std::min(around.completeTo, isFull ? farthest : result.lowerBound);
  }
  for (const SurfaceContact& contact : std::span(surfaceFound_).first(result.count)) {
    const ContactPair pair{contact.partPoint, contact.direction, contact.distance};
    if (!thinning_.add({inWorld(pair, other.worldFromPart), held.body})) around.completeTo = 0.0;
  }
}

Surroundings ContactFinder::find(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                                 double reach, double way, std::span<BodyContact> out) noexcept {
  const ServoScene& scene = *tracked.scene;
  if (!holdsFor(scene, worldFromPart, reach)) {
    if (!gatherPairs(tracked, worldFromPart, reach, way)) return {};
  }
  if (nextPair() > workLeft_) {
    workLeft_ = 0;
    return {};
  }
  Surroundings around{0, reach, reach};
  // Where no body is about, none is nearer than was looked for.
  if (bodyCount_ == 0) around.distance += holds_.travel - motionOf(scene, pairsPose_, worldFromPart).travel;
  thinning_.clear();
  for (const HeldBody& held : std::span(bodies_).first(bodyCount_)) {
    if (scene.bodies[held.body].surface)
      testSurface(scene, held, worldFromPart, around);
    else
      testPairs(scene, held, worldFromPart, around);
  }
  const glm::dquat principalFromWorld =
      glm::conjugate(worldFromPart.rotation * scene.metric.partFromPrincipal);
  const ContactThinning::Kept kept =
      thinning_.keep(worldFromPart.applyToPoint(scene.centreInPart), principalFromWorld, scene.metric, out);
  around.count = kept.count;
  around.completeTo = std::min(around.completeTo, kept.completeTo);
  return around;
}

}  // namespace nearfit
