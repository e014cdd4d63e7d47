#include "core/servo/contact_finder.h"

#include <algorithm>
#include <optional>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// Room for motion around a pose for which pairs are gathered, in reaches: a few steps of the proxy; more
/// for a fast hand.
constexpr double kMinSlack = 0.5, kMaxSlack = 6.0;
/// Limits that room to the travel of this many ticks at the speed of the last one.
constexpr double kTicksAhead = 1.5;
/// Limits the room for turning: beyond it, nearly every pair of features is a candidate [rad].
constexpr double kMaxTurn = 0.1;
/// Max pairs of triangles held: as many as a search can list within its work.
constexpr std::size_t kMaxTriangles = ContactFinder::kMaxSearchWork / kWorkOfListing;
/// Part of the remaining search work that one search for triangles may use. An abandoned search tells little,
/// so one step at full length is worth more than several looks; the rest allows a shorter look.
constexpr double kShareOfSearch = 0.75;
/// With more pairs than this, testing those added by the room for motion costs more than gathering again.
constexpr std::size_t kManyPairs = 2048;
/// If there are that many pairs even without room for motion, the reach is shortened, down to these many
/// margins. With two margins, a part in contact takes its steps (shorter than a margin) at full length.
/// With less, steps are shorter and the margin may shrink, but a part that is close to more than a tick can
/// test still moves.
constexpr std::array kShortReaches{2.0, 1.5, 1.1, 0.75, 0.5};
/// Levels of room: for the way ahead, for some steps, for one pose alone, then one per short reach.
constexpr std::size_t kLevelOfPose = 2, kLevels = kLevelOfPose + 1 + kShortReaches.size();
/// Work that must be left in a tick for another attempt with less room.
constexpr std::uint64_t kWorkOfAttempt = ContactFinder::kMaxWork / 4;
/// The same for the work on surfaces.
constexpr std::uint64_t kWorkOfSurfaceAttempt = ContactFinder::kMaxSurfaceWork / 4;
/// Fixed work for each body queried or held.
constexpr std::uint64_t kWorkOfBody = 1;
/// After a tick in which nothing could be seen, surfaces may use all the work for this many ticks.
constexpr unsigned kGenerousTicks = 16;
/// After this many gatherings with less room, more room is tried.
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

// The smallest scratch: contacts do not use the room in which minima are merged.
ContactFinder::ContactFinder()
    : scratch_(1),
      found_(ContactThinning::kMaxTaken),
      surfaceFound_(kMaxContacts),
      // A tick cannot test more.
      pairs_(kMaxWork),
      edgePairs_(kManyPairs / EdgePairs::kLanes),
      edgePairKernel_(edgePairKernel(defaultSimdLevel())),
      triangles_(kMaxTriangles) {}

void ContactFinder::beginTick() noexcept {
  workLeft_ = kMaxWork;
  isWorkSpent_ = false;
  searchWorkLeft_ = kMaxSearchWork;
  if (isBlind_)
    generousTicks_ = kGenerousTicks;
  else if (generousTicks_ > 0)
    --generousTicks_;
  surfaceWorkLeft_ = generousTicks_ > 0 ? kMaxWork : kMaxSurfaceWork;
  isBlind_ = false;
  lateBodies_ = 0;
  isFirstLook_ = true;
}

bool ContactFinder::holdsFor(const ServoScene& scene, const RigidTransform& worldFromPart,
                             double reach) const noexcept {
  return isHoldingPairs_ && reach == askedReach_ &&
         spentShare(motionOf(scene, pairsPose_, worldFromPart), holds_) <= 1.0;
}

bool ContactFinder::gatherOne(const TrackedScene& tracked, std::uint32_t body,
                              const TrackedScene::Near* known, const RigidTransform& worldFromPart,
                              const Gathering& gathering) noexcept {
  if (tracked.clearance.overlaps(body)) return true;
  if (bodyCount_ == kMaxBodies || workLeft_ < kWorkOfBody) return false;
  spend(kWorkOfBody);
  const ServoScene& scene = *tracked.scene;
  const ServoScene::Body& other = scene.bodies[body];
  if (other.surface) return gatherTriangles(scene, body, worldFromPart, gathering.slack);
  const NearbyPairs nearby = pairsOf(other, known, scene, worldFromPart, gathering);
  spend(nearby.work);
  bodies_[bodyCount_++] = {body, pairCount_, nearby.count};
  pairCount_ += nearby.count;
  holds_ = {std::min(holds_.travel, nearby.holds.travel), std::min(holds_.turn, nearby.holds.turn)};
  return nearby.isComplete;
}

NearbyPairs ContactFinder::pairsOf(const ServoScene::Body& other, const TrackedScene::Near* known,
                                   const ServoScene& scene, const RigidTransform& worldFromPart,
                                   const Gathering& gathering) noexcept {
  const ContactReach within{pairsReach_, contactTurn(pairsReach_, scene.metric.radius)};
  const RigidTransform bodyFromPart = (other.worldFromPart.inverse() * worldFromPart).normalized();
  const std::span<LeafPair> room = std::span(pairs_).subspan(pairCount_);
  if (known != nullptr && known->contacts) {
    // A tick cannot test more.
    const std::size_t bound = std::min<std::size_t>(gathering.mostListed, workLeft_);
    const std::size_t most = bound - std::min(bound, pairCount_);
    const std::optional<NearbyPairs> listed = known->contacts->nearbyPairs(
        bodyFromPart, within, gathering.slack, scratch_, room.first(std::min(room.size(), most)), workLeft_);
    if (listed) return *listed;
    isUncovered_ = known->contacts->size() > kMaxSearchWork;
  }
  ++lateBodies_;
  if (isUncovered_) return {};
  const NearbyPairs found =
      findNearbyPairs({other.geometry->tree(), scene.moving.geometry->tree(), bodyFromPart, pairsReach_},
                      within, gathering.slack, scratch_, room, std::min(searchWorkLeft_, workLeft_));
  searchWorkLeft_ -= found.work;
  return found;
}

bool ContactFinder::gatherTriangles(const ServoScene& scene, std::uint32_t body,
                                    const RigidTransform& worldFromPart, const MotionBudget& slack) noexcept {
  const ServoScene::Body& other = scene.bodies[body];
  const RigidTransform bodyFromPart = (other.worldFromPart.inverse() * worldFromPart).normalized();
  const double within = pairsReach_ + slack.travel;
  const std::uint64_t left = std::min(searchWorkLeft_, leftForSurfaces());
  const auto maxWork = static_cast<std::uint64_t>(kShareOfSearch * static_cast<double>(left));
  const NearbyTriangles nearby =
      findNearbyTriangles(*other.surface, *scene.moving.surface, bodyFromPart, within, scratch_,
                          std::span(triangles_).subspan(triangleCount_), maxWork);
  searchWorkLeft_ -= nearby.work;
  spendOnSurface(nearby.work);
  bodies_[bodyCount_++] = {body, triangleCount_, nearby.count, nearby.within};
  triangleCount_ += nearby.count;
  isSurfaceNear_ = true;
  // For a single pose an incomplete set serves, if the missing pairs are known to be farther away.
  return nearby.within == within || (slack.travel == 0.0 && nearby.within > 0.0);
}

bool ContactFinder::hasWorkForAttempt() const noexcept {
  if (workLeft_ < kWorkOfAttempt) return false;
  return !isSurfaceNear_ || std::min(searchWorkLeft_, surfaceWorkLeft_) >= kWorkOfSurfaceAttempt;
}

bool ContactFinder::gatherPairs(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                                double reach, double way) noexcept {
  const double radius = tracked.scene->metric.radius;
  // If no body was near, the whole way may be free.
  const double wanted = bodyCount_ == 0 ? way : std::min(way, kTicksAhead * tickTravel_);
  const auto gather = [&](std::size_t level) {
    const double travel = level == 0             ? std::clamp(wanted, kMinSlack * reach, kMaxSlack * reach)
                          : level < kLevelOfPose ? kMinSlack * reach
                                                 : 0.0;
    askedReach_ = reach;
    pairsReach_ =
        level <= kLevelOfPose ? reach : kShortReaches[level - kLevelOfPose - 1] / kContactReach * reach;
    const std::size_t mostListed = level > kLevelOfPose ? pairs_.size() : kManyPairs;
    return gatherWithin(tracked, worldFromPart, {{travel, std::min(travel / radius, kMaxTurn)}, mostListed});
  };
  // Where pairs were many, they most likely still are. Now and then more room is tried, and after a success
  // tried again at once.
  const bool isTry = roomLevel_ > 0 && ++gatherings_ % kGatheringsBetweenTries == 0;
  if (isTry) --roomLevel_;
  // A failure after other poses have used up work says nothing about later ticks.
  const bool isFirst = workLeft_ == kMaxWork;
  if (isFirst || isTry) tickLevel_ = roomLevel_;
  const auto keep = [&](std::size_t level) {
    tickLevel_ = level;
    if (isFirst || isTry) roomLevel_ = level;
  };
  for (std::size_t level = tickLevel_; level < kLevels; ++level) {
    if (gather(level)) {
      if (isTry && level == roomLevel_) gatherings_ = kGatheringsBetweenTries - 1;
      keep(level);
      return true;
    }
    // A shorter step may help here, but less room does not.
    if (isUncovered_) return false;
    if (hasWorkForAttempt()) continue;
    keep(std::min(std::max(level + 1, kLevelOfPose), kLevels - 1));
    return false;
  }
  keep(kLevels - 1);
  return false;
}

bool ContactFinder::gatherWithin(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                                 const Gathering& gathering) noexcept {
  bodyCount_ = pairCount_ = triangleCount_ = 0;
  isUncovered_ = isSurfaceNear_ = false;
  pairsPose_ = testedPose_ = worldFromPart;
  holds_ = gathering.slack;
  bool isComplete = true;
  const double far = pairsReach_ + gathering.slack.travel;
  const double spent = tracked.spent(worldFromPart, far);
  // Bodies not listed as near stay so only within the rest of the budget.
  if (spent <= 1.0) {
    const MotionBudget left = (1.0 - spent) * tracked.clear;
    holds_ = {std::min(holds_.travel, left.travel), std::min(holds_.turn, left.turn)};
  }
  tracked.visitNear(worldFromPart, far, [&](std::uint32_t body, const TrackedScene::Near* known) {
    isComplete = isComplete && gatherOne(tracked, body, known, worldFromPart, gathering);
  });
  isHoldingPairs_ = isComplete && pairCount_ + bodyCount_ * kWorkOfBody <= workLeft_;
  // Packing does not pay for a single pose.
  if (isHoldingPairs_ && gathering.slack.travel > 0.0) packPairs(*tracked.scene);
  return isHoldingPairs_;
}

void ContactFinder::packPairs(const ServoScene& scene) noexcept {
  std::size_t used = 0;
  for (HeldBody& held : std::span(bodies_).first(bodyCount_)) {
    const ServoScene::Body& other = scene.bodies[held.body];
    if (other.surface) continue;
    held.firstBlock = used;
    held.blocks =
        packEdgePairs(other.geometry->tree(), scene.moving.geometry->tree(),
                      std::span(pairs_).subspan(held.first, held.count), std::span(edgePairs_).subspan(used));
    used += held.blocks;
  }
}

void ContactFinder::testPairs(const ServoScene& scene, const HeldBody& held,
                              const RigidTransform& worldFromPart, Surroundings& around) noexcept {
  const ServoScene::Body& other = scene.bodies[held.body];
  const ContactReach within{pairsReach_, contactTurn(pairsReach_, scene.metric.radius)};
  const RigidTransform bodyFromPart = (other.worldFromPart.inverse() * worldFromPart).normalized();
  const ContactResult result =
      testContacts({other.geometry->tree(), scene.moving.geometry->tree(), bodyFromPart, pairsReach_}, within,
                   std::span<const LeafPair>(pairs_).subspan(held.first, held.count), found_,
                   {std::span(edgePairs_).subspan(held.firstBlock, held.blocks), edgePairKernel_});
  spend(result.leafPairs);
  around.distance = std::min(around.distance, result.distanceBound());
  around.deviation = std::max(around.deviation, scene.deviation(other));
  around.completeTo = std::min(around.completeTo, result.completeTo);
  for (const ContactPair& pair : std::span(found_).first(result.count)) {
    if (!thinning_.add({inWorld(pair, other.worldFromPart), held.body})) around.completeTo = 0.0;
  }
}

void ContactFinder::testSurface(const ServoScene& scene, const HeldBody& held,
                                const RigidTransform& worldFromPart, Surroundings& around) noexcept {
  const ServoScene::Body& other = scene.bodies[held.body];
  const RigidTransform bodyFromPart = (other.worldFromPart.inverse() * worldFromPart).normalized();
  const HeldTriangles triangles{std::span(triangles_).subspan(held.first, held.count), held.within,
                                motionOf(scene, pairsPose_, worldFromPart).travel,
                                motionOf(scene, testedPose_, worldFromPart).travel};
  const SurfaceContacts result = testTriangles(*other.surface, *scene.moving.surface, bodyFromPart,
                                               pairsReach_, triangles, surfaceFound_, leftForSurfaces());
  spendOnSurface(result.work);
  around.distance = std::min(around.distance, result.lowerBound);
  around.deviation = std::max(around.deviation, scene.deviation(other));
  around.completeTo = std::min(around.completeTo, result.completeTo);
  for (const SurfaceContact& contact : std::span(surfaceFound_).first(result.count)) {
    const ContactPair pair{contact.partPoint, contact.direction, contact.distance};
    if (!thinning_.add({inWorld(pair, other.worldFromPart), held.body})) around.completeTo = 0.0;
  }
}

void ContactFinder::testBodies(const ServoScene& scene, const RigidTransform& worldFromPart,
                               Surroundings& around) noexcept {
  spend(bodyCount_ * kWorkOfBody);
  const std::span<const HeldBody> held = std::span(bodies_).first(bodyCount_);
  // Surfaces get the work that is left, since testing only their nearest triangles is enough.
  for (const HeldBody& body : held) {
    if (!scene.bodies[body.body].surface) testPairs(scene, body, worldFromPart, around);
  }
  for (const HeldBody& body : held) {
    if (scene.bodies[body.body].surface) testSurface(scene, body, worldFromPart, around);
  }
  testedPose_ = worldFromPart;
}

Surroundings ContactFinder::find(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                                 double reach, double way, std::span<BodyContact> out) noexcept {
  const Surroundings around = look(tracked, worldFromPart, reach, way, out);
  isBlind_ = (isBlind_ || isFirstLook_) && !(around.distance > 0.0);
  isFirstLook_ = false;
  return around;
}

Surroundings ContactFinder::look(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                                 double reach, double way, std::span<BodyContact> out) noexcept {
  const ServoScene& scene = *tracked.scene;
  if (isFirstLook_) {
    tickTravel_ = motionOf(scene, tickPose_, worldFromPart).travel;
    tickPose_ = worldFromPart;
  }
  if (!holdsFor(scene, worldFromPart, reach)) {
    if (!gatherPairs(tracked, worldFromPart, reach, way)) return {};
  }
  // Pairs that have served before are kept for the next tick.
  if (pairCount_ + bodyCount_ * kWorkOfBody > workLeft_) {
    isWorkSpent_ = true;
    return {};
  }
  Surroundings around{0, pairsReach_, pairsReach_, pairsReach_, 0.0};
  // With no body near, nothing is nearer than the distance searched, room for motion included.
  if (bodyCount_ == 0) around.distance += holds_.travel - motionOf(scene, pairsPose_, worldFromPart).travel;
  thinning_.clear();
  testBodies(scene, worldFromPart, around);
  const glm::dquat principalFromWorld = scene.metric.principalFromWorld(worldFromPart);
  const ContactThinning::Kept kept =
      thinning_.keep(worldFromPart.applyToPoint(scene.centreInPart), principalFromWorld, scene.metric, out);
  around.count = kept.count;
  around.completeTo = std::min(around.completeTo, kept.completeTo);
  return around;
}

}  // namespace nearfit
