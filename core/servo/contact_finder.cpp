#include "core/servo/contact_finder.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/math/rotation_vector.h"
#include "core/proximity/query/pair_passage.h"

namespace nearfit {
namespace {

/// Room for motion around a pose for which pairs are gathered, in reaches: a few steps of the proxy; more
/// for a fast hand.
constexpr double kMinSlack = 0.5, kMaxSlack = 6.0;
/// Limits that room to the travel of this many ticks at the speed of the last one, or of this many steps like
/// the one that is tried: it reaches back to where that comes from.
constexpr double kTicksAhead = 1.5, kStepsAhead = 4.0;
/// Where pairs are thousands, they are gathered for the way of so many steps like the one that is tried, as far as the
/// lists cover it: few more are near along the way, and most near one end are near the other. They serve this far aside
/// of it, in reaches: a nut strays little from its thread, and room aside costs pairs all along the way.
constexpr std::array kStepsOfStretch{8.0, 4.0, 2.0, 1.0};
constexpr double kAside = 0.07;
/// Limits the room for turning: beyond it, nearly every pair of features is a candidate [rad].
constexpr double kMaxTurn = 0.1;
/// Max pairs of triangles held: a pass over all of them takes a twentieth of a tick's work on surfaces.
constexpr std::size_t kMaxTriangles = ContactFinder::kMaxSurfaceWork;
/// Pairs of triangles taken from a list in the time of a unit of work.
constexpr std::uint64_t kTakenOfWork = 16;
/// Part of the remaining search work that one search for triangles may use. An abandoned search tells little,
/// so one step at full length is worth more than several looks; the rest allows a shorter look.
constexpr double kShareOfSearch = 0.75;
/// Room that pairs are gathered with, and how far.
struct Level {
  double reach;            ///< Max distance of contacts [margins].
  double mostSlack;        ///< Max room for motion [reaches]; kMinSlack for some steps, 0 for one pose alone.
  std::size_t mostListed;  ///< Max pairs worth taking from lists.
};
/// Where there are more pairs than kManyPairs / 2, it looks no farther than a part in contact needs to keep its margin
/// (kSight in proxy.cpp): there are a sixth fewer than within 1.75 margins, for steps as long. If there are too many even
/// without room, the reach is shortened further: steps are shorter and the margin may shrink, but a part that is close to
/// more than a tick can look at still moves.
constexpr std::array kLevels{Level{kContactReach, kMaxSlack, ContactFinder::kManyPairs / 2},
                             Level{kContactReach, kMinSlack, ContactFinder::kManyPairs / 2},
                             Level{kReachOfThousands, 1.0, ContactFinder::kMaxPairs},
                             Level{kReachOfThousands, kMinSlack, ContactFinder::kMaxPairs},
                             Level{kReachOfThousands, 0.0, ContactFinder::kMaxPairs},
                             Level{1.1, 0.0, ContactFinder::kMaxPairs},
                             Level{0.75, 0.0, ContactFinder::kMaxPairs},
                             Level{0.5, 0.0, ContactFinder::kMaxPairs}};
/// From this level on pairs are thousands.
constexpr std::size_t kLevelOfThousands = 2;
/// Gathering that begins with no more work done counts as having had a whole tick.
constexpr std::uint64_t kFreshWork = ContactFinder::kUsualWork / 4;
/// Work that must be left in a tick for another attempt with less room.
constexpr std::uint64_t kWorkOfAttempt = ContactFinder::kMaxWork - ContactFinder::kUsualWork / 2;
/// The same for the work on surfaces.
constexpr std::uint64_t kWorkOfSurfaceAttempt = ContactFinder::kMaxSurfaceWork / 4;
/// Max work of a search for a step that is longer than a list covers: a shorter step is tried next.
constexpr std::uint64_t kWorkBesideList = ContactFinder::kMaxSearchWork / 8;
/// Fixed work for each body queried or held.
constexpr std::uint64_t kWorkOfBody = 1;
/// Work of testing a pair that is not packed. One that is takes 1, and 1 more to be packed; each contact found takes
/// 1 more.
constexpr std::uint64_t kWorkOfPairTest = 2;
/// Work of finding how near a pair comes on a way.
constexpr std::uint64_t kWorkOfPassage = 1;
/// Bend of a way seen from the part, per turn and travel: its second derivative is at most twice their product.
constexpr double kBendOfShift = 0.25;
/// A pair that stays this far apart on a way is clear, as a share of the reach.
constexpr double kClearOnWay = 0.1;
/// Pairs tested before it is asked again whether work is left.
constexpr std::size_t kChunk = 64;
/// After a tick in which nothing could be seen, surfaces may use all the work for this many ticks.
constexpr unsigned kGenerousTicks = 16;
/// After this many gatherings of few pairs it is no longer crowded.
constexpr unsigned kSparseGatherings = 64;
/// After this many gatherings with less room, more room is tried.
constexpr unsigned kGatheringsBetweenTries = 16;

/// A pose of a body as a matrix, for many contacts.
struct Placement {
  glm::dmat3 turn;
  glm::dvec3 shift;
  explicit Placement(const RigidTransform& pose) noexcept
      : turn(glm::mat3_cast(pose.rotation)), shift(pose.translation) {}
  ContactPair inWorld(const ContactPair& pair) const noexcept {
    return {turn * pair.point + shift, turn * pair.direction, pair.distance};
  }
};

/// A pose of the part with the origin at its centre of mass.
RigidTransform centredAtMass(const ServoScene& scene, const RigidTransform& worldFromPart) noexcept {
  return {worldFromPart.rotation, worldFromPart.applyToPoint(scene.centreInPart)};
}

/// Motion of the part between two poses, about its centre of mass.
MotionBudget motionOf(const ServoScene& scene, const RigidTransform& from,
                      const RigidTransform& to) noexcept {
  return motionBetween(centredAtMass(scene, from), centredAtMass(scene, to), scene.metric.radius);
}

/// The stretch between two poses of the centre of mass, about their middle.
MotionStretch stretchBetween(const RigidTransform& from, const RigidTransform& to) noexcept {
  return {0.5 * (to.translation - from.translation),
          0.5 * rotationVector(to.rotation * glm::conjugate(from.rotation))};
}

RigidTransform middleOf(const RigidTransform& from, const MotionStretch& stretch) noexcept {
  return {glm::normalize(rotationOf(stretch.spin) * from.rotation), from.translation + stretch.shift};
}

/// Pose of a body whose centre of mass is there.
RigidTransform poseOfMass(const ServoScene& scene, const RigidTransform& centred) noexcept {
  return {centred.rotation, centred.translation - centred.rotation * scene.centreInPart};
}

/// Way of the part past a body between two poses, worldFromPart.
PartWay wayOf(const ServoScene& scene, const ServoScene::Body& body, const RigidTransform& from,
              const RigidTransform& to) noexcept {
  const MotionBudget motion = motionOf(scene, from, to);
  const RigidTransform bodyFromWorld = body.worldFromPart.inverse();
  return {(bodyFromWorld * from).normalized(), (bodyFromWorld * to).normalized(), motion.travel,
          bendOf(motion.turn, scene.metric.radius)};
}

}  // namespace

// The smallest scratch: contacts do not use the room in which minima are merged.
ContactFinder::ContactFinder()
    : scratch_(1),
      found_(kChunk),
      surfaceFound_(kMaxContacts),
      pairs_(kMaxPairs),
      edgePairs_(kManyPairs / EdgePairs::kLanes),
      edgePairKernels_(edgePairKernels(defaultSimdLevel())),
      triangles_(kMaxTriangles) {}

void ContactFinder::forget() noexcept {
  isHoldingPairs_ = false;
  giveUpLook();
  for (ManyOfBody& many : many_)
    many.body.reset();
}

void ContactFinder::beginTick() noexcept {
  allowed_ = workDone_ = 0;
  excess_ = Excess::None;
  searchWorkLeft_ = kMaxSearchWork;
  if (isBlind_)
    generousTicks_ = kGenerousTicks;
  else if (generousTicks_ > 0)
    --generousTicks_;
  surfaceWorkLeft_ = generousTicks_ > 0 ? 2 * kMaxSurfaceWork : kMaxSurfaceWork;
  isBlind_ = false;
  lateBodies_ = 0;
  isFirstLook_ = isFirstGathering_ = true;
  tickLevel_ = roomLevel_;
}

void ContactFinder::allow(std::uint64_t work, Excess excess) noexcept {
  allowed_ += work;
  excess_ = excess;
}

bool ContactFinder::holdsFor(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                             double reach) const noexcept {
  return isHoldingPairs_ && reach == askedReach_ && arePreparedCurrent(tracked) &&
         spentOfHeld(*tracked.scene, worldFromPart) <= 1.0;
}

bool ContactFinder::arePreparedCurrent(const TrackedScene& tracked) const noexcept {
  return std::ranges::all_of(std::span(bodies_).first(bodyCount_), [&](const HeldBody& held) {
    if (held.prepared == nullptr) return true;
    const auto near = std::ranges::find(tracked.near, held.body, &TrackedScene::Near::body);
    if (near == tracked.near.end()) return false;
    const auto isStill = [&](const std::shared_ptr<PreparedPairs>& of) {
      return of && of->isStill(held.prepared, held.preparedSerial, this);
    };
    return isStill(near->prepared) || isStill(near->formerPrepared);
  });
}

void ContactFinder::noteCrowd() noexcept {
  std::size_t most = isHoldingPrepared() ? ManyPairs::kFew : 0;
  for (const HeldBody& held : std::span(bodies_).first(bodyCount_))
    most = std::max(most, held.count);
  sparseGatherings_ = most < ManyPairs::kFew / 2 ? sparseGatherings_ + 1 : 0;
  if (tickLevel_ >= kLevelOfThousands && most >= ManyPairs::kFew)
    isCrowded_ = true;
  else if (sparseGatherings_ >= kSparseGatherings)
    isCrowded_ = false;
}

double ContactFinder::spentOfHeld(const ServoScene& scene,
                                  const RigidTransform& worldFromPart) const noexcept {
  if (stretchTravel_ == 0.0) return spentShare(motionOf(scene, pairsPose_, worldFromPart), holds_);
  return spentShare({stretch_, holds_}, centredAtMass(scene, pairsPose_), centredAtMass(scene, worldFromPart),
                    scene.metric.radius);
}

ContactFinder::Gathered ContactFinder::gatherOne(const TrackedScene& tracked, std::uint32_t body,
                                                 const TrackedScene::Near* known,
                                                 const RigidTransform& worldFromPart,
                                                 const Gathering& gathering) noexcept {
  if (tracked.clearance.overlaps(body)) return Gathered::Held;
  if (bodyCount_ == kMaxBodies) return Gathered::TooMany;
  if (leftToGather() < kWorkOfBody) return Gathered::NoWork;
  spend(kWorkOfBody);
  const ServoScene& scene = *tracked.scene;
  const ServoScene::Body& other = scene.bodies[body];
  return other.surface ? gatherTriangles(scene, body, known, worldFromPart, gathering.slack)
                       : gatherFeatures(other, body, known, scene, worldFromPart, gathering);
}

ContactFinder::Gathered ContactFinder::gatherFeatures(const ServoScene::Body& other, std::uint32_t body,
                                                      const TrackedScene::Near* known,
                                                      const ServoScene& scene,
                                                      const RigidTransform& worldFromPart,
                                                      const Gathering& gathering) noexcept {
  const ContactReach within{pairsReach_, contactTurn(pairsReach_, scene.metric.radius)};
  const auto poseAt = [&](const RigidTransform& pose) {
    return (other.worldFromPart.inverse() * pose).normalized();
  };
  const std::span<LeafPair> room = std::span(pairs_).subspan(pairCount_);
  const auto take = [&](const NearbyPairs& nearby, std::size_t most) {
    spend(nearby.work);
    bodies_[bodyCount_++] = {body, pairCount_, nearby.count};
    pairCount_ += nearby.count;
    holds_ = {std::min(holds_.travel, nearby.holds.travel), std::min(holds_.turn, nearby.holds.turn)};
    if (nearby.isComplete) return Gathered::Held;
    return nearby.count < most ? Gathered::NoWork : Gathered::TooMany;
  };
  bool isSearchHopeless = false, mayStepLess = false;
  if (known != nullptr && known->contacts && known->prepared && known->prepared->reach() >= pairsReach_) {
    const Stretch way = gathering.stretch.value_or(Stretch{worldFromPart, worldFromPart});
    const std::optional<MotionBudget> left =
        known->contacts->roomAlong(poseAt(way.from), poseAt(way.to), within);
    ManyPairs* const prepared = left ? known->prepared->claim(this) : nullptr;
    if (prepared != nullptr) {
      bodies_[bodyCount_++] = {.body = body,
                               .first = pairCount_,
                               .prepared = prepared,
                               .preparedSerial = known->prepared->serial()};
      holds_ = {std::min(holds_.travel, left->travel), std::min(holds_.turn, left->turn)};
      return Gathered::Held;
    }
  }
  // A pass over thousands begins early in a tick.
  if (known != nullptr && known->prepared && workDone_ > kUsualWork) return Gathered::NoWork;
  if (known != nullptr && known->contacts) {
    const std::size_t most =
        std::min(room.size(), gathering.mostListed - std::min(gathering.mostListed, pairCount_));
    const Stretch way = gathering.stretch.value_or(Stretch{worldFromPart, worldFromPart});
    const std::optional<NearbyPairs> listed =
        known->contacts->nearbyPairsAlong(poseAt(way.from), poseAt(way.to), within, gathering.slack, scratch_,
                                          room.first(most), leftToGather());
    if (listed) return take(*listed, most);
    isSearchHopeless = known->contacts->size() > kMaxSearchWork;
    mayStepLess = gathering.isOfStep;
  }
  ++lateBodies_;
  if (isSearchHopeless) return Gathered::NoList;
  const NearbyPairs found = findNearbyPairs(
      {other.geometry->tree(), scene.moving.geometry->tree(), poseAt(worldFromPart), pairsReach_}, within,
      gathering.slack, scratch_, room,
      std::min({searchWorkLeft_, leftToGather(), mayStepLess ? kWorkBesideList : kMaxWork}));
  searchWorkLeft_ -= found.work;
  const Gathered outcome = take(found, room.size());
  return outcome == Gathered::NoWork && mayStepLess && found.work >= kWorkBesideList ? Gathered::NoList
                                                                                     : outcome;
}

bool ContactFinder::takeListed(const TriangleList& list, std::uint32_t body,
                               const RigidTransform& bodyFromPart, const MotionBudget& slack) noexcept {
  const std::span<TrianglePair> room = std::span(triangles_).subspan(triangleCount_);
  const TriangleList::Around around = list.around(bodyFromPart, room.size());
  const double serves = around.within - pairsReach_;
  if (!(serves >= std::min(slack.travel, kMinSlack * pairsReach_)) ||
      leftForSurfaces() < around.pairs.size() / kTakenOfWork)
    return false;
  spendOnSurface(around.pairs.size() / kTakenOfWork);
  for (std::size_t i = 0; i < around.pairs.size(); ++i) {
    TrianglePair& pair = room[i] = around.pairs[i];
    pair.atLeast = pair.known = std::max(0.0, pair.atLeast - around.travel);
  }
  bodies_[bodyCount_++] = {.body = body,
                           .first = triangleCount_,
                           .count = around.pairs.size(),
                           .within = around.within,
                           .testedPose = pairsPose_};
  triangleCount_ += around.pairs.size();
  listedTravel_ = std::min(listedTravel_, serves);
  isSurfaceNear_ = true;
  return true;
}

ContactFinder::Gathered ContactFinder::gatherTriangles(const ServoScene& scene, std::uint32_t body,
                                                       const TrackedScene::Near* known,
                                                       const RigidTransform& worldFromPart,
                                                       const MotionBudget& slack) noexcept {
  const ServoScene::Body& other = scene.bodies[body];
  const RigidTransform bodyFromPart = (other.worldFromPart.inverse() * worldFromPart).normalized();
  if (known != nullptr && known->triangles && takeListed(*known->triangles, body, bodyFromPart, slack))
    return Gathered::Held;
  listedTravel_ = 0.0;
  ++lateBodies_;
  // A search that is left off tells little: it waits for work enough.
  if (excess_ == Excess::None) return Gathered::NoWork;
  const double within = pairsReach_ + slack.travel;
  const std::uint64_t left = std::min(searchWorkLeft_, leftForSurfaces());
  const auto maxWork = static_cast<std::uint64_t>(kShareOfSearch * static_cast<double>(left));
  const NearbyTriangles nearby =
      findNearbyTriangles(*other.surface, *scene.moving.surface, bodyFromPart, within, scratch_,
                          std::span(triangles_).subspan(triangleCount_), maxWork);
  searchWorkLeft_ -= nearby.work;
  spendOnSurface(nearby.work);
  bodies_[bodyCount_++] = {.body = body,
                           .first = triangleCount_,
                           .count = nearby.count,
                           .within = nearby.within,
                           .testedPose = pairsPose_};
  triangleCount_ += nearby.count;
  isSurfaceNear_ = true;
  // For a single pose an incomplete set serves, if the missing pairs are known to be farther away.
  const bool isEnough = nearby.within == within || (slack.travel == 0.0 && nearby.within > 0.0);
  return isEnough ? Gathered::Held : Gathered::TooMany;
}

bool ContactFinder::hasWorkForAttempt() const noexcept {
  if (leftToGather() < kWorkOfAttempt) return false;
  return !isSurfaceNear_ || std::min(searchWorkLeft_, surfaceWorkLeft_) >= kWorkOfSurfaceAttempt;
}

std::optional<ContactFinder::Stretch> ContactFinder::stretchFor(const TrackedScene& tracked,
                                                                const RigidTransform& worldFromPart,
                                                                const RigidTransform& from,
                                                                const ContactReach& reach,
                                                                const MotionBudget& slack) const noexcept {
  const ServoScene& scene = *tracked.scene;
  if (scene.hasSurfaces()) return std::nullopt;
  const RigidTransform begin = centredAtMass(scene, from);
  const MotionStretch step = stretchBetween(begin, centredAtMass(scene, worldFromPart));
  for (const double steps : kStepsOfStretch) {
    const RigidTransform end = middleOf(begin, {2.0 * steps * step.shift, 2.0 * steps * step.spin});
    const Stretch stretch{from, poseOfMass(scene, end)};
    const MotionBudget whole = motionBetween(begin, end, scene.metric.radius);
    // Bodies that are not listed must stay clear of all of it.
    const double far = reach.distance + slack.travel + 0.5 * whole.travel;
    const RigidTransform middle = poseOfMass(scene, middleOf(begin, {steps * step.shift, steps * step.spin}));
    const double spent = tracked.spent(middle, far);
    if (!(spent <= 1.0)) continue;
    const MotionBudget half{0.5 * whole.travel + slack.travel, 0.5 * whole.turn + slack.turn};
    if (!(spentShare(half, (1.0 - spent) * tracked.clear) <= 1.0)) continue;
    const bool isCovered = std::ranges::all_of(tracked.near, [&](const TrackedScene::Near& near) {
      if (tracked.clearance.overlaps(near.body)) return true;
      if (!near.contacts) return false;
      const RigidTransform bodyFromWorld = scene.bodies[near.body].worldFromPart.inverse();
      const std::optional<MotionBudget> room = near.contacts->roomAlong(
          (bodyFromWorld * stretch.from).normalized(), (bodyFromWorld * stretch.to).normalized(), reach);
      return room && spentShare(slack, *room) <= 1.0;
    });
    if (isCovered) return stretch;
  }
  return std::nullopt;
}

ContactFinder::Gathered ContactFinder::gatherPairs(const TrackedScene& tracked,
                                                   const RigidTransform& worldFromPart, double reach,
                                                   double way, const Step* step) noexcept {
  // A pass over a long list begins early in a tick.
  if (isHoldingMany() && workDone_ > kUsualWork) return Gathered::Postponed;
  const ServoScene& scene = *tracked.scene;
  const double radius = scene.metric.radius;
  const double stepTravel = step != nullptr ? motionOf(scene, step->from, worldFromPart).travel : 0.0;
  // If no body was near, the whole way may be free.
  const double likely = std::max(kTicksAhead * tickTravel_, kStepsAhead * stepTravel);
  const double wanted = bodyCount_ == 0 ? way : std::min(way, likely);
  const auto gather = [&](std::size_t at) {
    const Level& level = kLevels[at];
    askedReach_ = reach;
    pairsReach_ = level.reach / kContactReach * reach;
    if (stepTravel > 0.0 && (isAmongThousands() || at >= kLevelOfThousands)) {
      const double aside = kAside * reach;
      const MotionBudget slack{aside, aside / radius};
      const std::optional<Stretch> stretch = stretchFor(
          tracked, worldFromPart, step->from, {pairsReach_, contactTurn(pairsReach_, radius)}, slack);
      if (stretch) return gatherWithin(tracked, worldFromPart, {slack, level.mostListed, true, stretch});
    }
    const double travel =
        level.mostSlack > 0.0 ? std::clamp(wanted, kMinSlack * reach, level.mostSlack * reach) : 0.0;
    return gatherWithin(tracked, worldFromPart,
                        {{travel, std::min(travel / radius, kMaxTurn)}, level.mostListed, stepTravel > 0.0});
  };
  // Where pairs were many, they most likely still are. Now and then more room is tried, and after a success
  // tried again at once.
  const bool isListNear = std::ranges::any_of(tracked.near, [&](const TrackedScene::Near& near) {
    return near.contacts && near.contacts->cutoff() < tracked.reach.contact;
  });
  const std::size_t lowest = isListNear ? kLevelOfThousands : 0;
  roomLevel_ = std::max(roomLevel_, lowest);
  tickLevel_ = std::max(tickLevel_, lowest);
  const bool isTry = roomLevel_ > lowest && ++gatherings_ % kGatheringsBetweenTries == 0;
  if (isTry) --roomLevel_;
  // A failure with little work, or after other poses have used it up, says nothing about later ticks.
  const bool isFirst = excess_ == Excess::ToGather && std::exchange(isFirstGathering_, false);
  if (isTry) tickLevel_ = roomLevel_;
  const auto keep = [&](std::size_t level) {
    tickLevel_ = level;
    if (isFirst || isTry) roomLevel_ = level;
  };
  const bool isFresh = excess_ == Excess::ToGather && workDone_ <= kFreshWork;
  for (std::size_t level = tickLevel_; level < kLevels.size(); ++level) {
    const Gathered outcome = gather(level);
    if (outcome == Gathered::Held) {
      if (isTry && level == roomLevel_) gatherings_ = kGatheringsBetweenTries - 1;
      keep(level);
    }
    // A shorter step may be covered by the list, but less room does not help.
    if (outcome == Gathered::Held || outcome == Gathered::NoList) return outcome;
    // What did not fit into the rest of a tick may fit into a whole one.
    if (outcome == Gathered::NoWork && !isFresh) return Gathered::Postponed;
    if (hasWorkForAttempt()) continue;
    keep(std::min(level + 1, kLevels.size() - 1));
    // The next tick tries with less room, unless this is the last level.
    return isSurfaceNear_ || level + 1 == kLevels.size() ? outcome : Gathered::Postponed;
  }
  keep(kLevels.size() - 1);
  return Gathered::TooMany;
}

ContactFinder::Gathered ContactFinder::gatherWithin(const TrackedScene& tracked,
                                                    const RigidTransform& worldFromPart,
                                                    const Gathering& gathering) noexcept {
  bodyCount_ = pairCount_ = triangleCount_ = 0;
  isSurfaceNear_ = false;
  const ServoScene& scene = *tracked.scene;
  pairsPose_ = worldFromPart;
  holds_ = gathering.slack;
  stretch_ = {};
  stretchTravel_ = 0.0;
  Gathered outcome = Gathered::Held;
  double far = pairsReach_ + gathering.slack.travel;
  if (gathering.stretch) {
    const RigidTransform from = centredAtMass(scene, gathering.stretch->from);
    const RigidTransform to = centredAtMass(scene, gathering.stretch->to);
    stretch_ = stretchBetween(from, to);
    stretchTravel_ = motionBetween(from, to, scene.metric.radius).travel;
    pairsPose_ = poseOfMass(scene, middleOf(from, stretch_));
    far += 0.5 * stretchTravel_;
  }
  const double spent = tracked.spent(pairsPose_, far);
  // Bodies not listed as near stay so only within the rest of the budget, which a stretch was found to keep to.
  MotionBudget left = gathering.slack;
  if (spent <= 1.0 && !gathering.stretch) {
    left = (1.0 - spent) * tracked.clear;
    holds_ = {std::min(holds_.travel, left.travel), std::min(holds_.turn, left.turn)};
  }
  listedTravel_ = std::numeric_limits<double>::infinity();
  tracked.visitNear(pairsPose_, far, [&](std::uint32_t body, const TrackedScene::Near* known) {
    if (outcome == Gathered::Held) outcome = gatherOne(tracked, body, known, worldFromPart, gathering);
  });
  // Lists of triangles are held as far as they serve.
  if (isSurfaceNear_ && listedTravel_ > 0.0) {
    const MotionBudget most = pairCount_ == 0 && !isHoldingPrepared() ? left : holds_;
    holds_.travel = std::min(listedTravel_, most.travel);
    holds_.turn = std::min(holds_.travel / scene.metric.radius, most.turn);
  }
  isHoldingPairs_ = outcome == Gathered::Held;
  arranging_ = {};
  if (gathering.stretch) {
    // Lists follow the middle of the part's box, and its centre of mass strays from that way as the part turns.
    const double turn = 2.0 * glm::length(stretch_.spin);
    holds_.travel = std::max(0.0, holds_.travel - bendOf(turn, scene.metric.radius));
  }
  return outcome;
}

std::size_t ContactFinder::manyFor(const HeldBody& held) noexcept {
  if (held.count < ManyPairs::kFew) return kMaxMany;
  std::size_t place = kMaxMany;
  for (std::size_t i = 0; i < many_.size(); ++i) {
    if (many_[i].body == held.body) return i;
    if (!many_[i].isHeld) place = i;
  }
  if (place == kMaxMany) return place;
  many_[place].pairs.forget();
  many_[place].body = held.body;
  many_[place].pose = pairsPose_;
  return place;
}

bool ContactFinder::arrangePairs(const ServoScene& scene) noexcept {
  const std::span<HeldBody> bodies = std::span(bodies_).first(bodyCount_);
  for (ManyOfBody& many : many_) {
    many.isHeld = many.body && std::ranges::any_of(bodies, [&](const HeldBody& held) {
                    return held.body == *many.body && held.count >= ManyPairs::kFew;
                  });
  }
  for (; arranging_.bodies < bodies.size(); ++arranging_.bodies) {
    HeldBody& held = bodies[arranging_.bodies];
    if (scene.bodies[held.body].surface || held.prepared != nullptr) continue;
    const std::span<LeafPair> pairs = std::span(pairs_).subspan(held.first, held.count);
    if (!arranging_.isHolding) held.many = manyFor(held);
    if (held.many < kMaxMany) {
      if (!holdMany(scene, many_[held.many], pairs)) return false;
      continue;
    }
    held.firstBlock = arranging_.blocks;
    held.blocks =
        std::min(edgePairsToFront(pairs) / EdgePairs::kLanes, edgePairs_.size() - arranging_.blocks);
    arranging_.blocks += held.blocks;
  }
  arranging_.isDone = true;
  return true;
}

bool ContactFinder::holdMany(const ServoScene& scene, ManyOfBody& many,
                             std::span<const LeafPair> pairs) noexcept {
  many.isHeld = true;
  // The wrench does not wait for it.
  if (excess_ == Excess::None) return false;
  if (!arranging_.isHolding) {
    many.pairs.beginHolding(pairs, motionOf(scene, many.pose, pairsPose_).turn);
    many.pose = pairsPose_;
  }
  std::uint64_t left = workLeft();
  const std::uint64_t before = left;
  arranging_.isHolding = !many.pairs.goOnHolding(left);
  spend(before - left);
  return !arranging_.isHolding;
}

void ContactFinder::testPairs(const ServoScene& scene, HeldBody& held, std::size_t first,
                              std::size_t count) noexcept {
  const ServoScene::Body& other = scene.bodies[held.body];
  const NormalConeTree &tree = other.geometry->tree(), &part = scene.moving.geometry->tree();
  const std::span<const LeafPair> pairs = std::span<const LeafPair>(pairs_).subspan(held.first, held.count);
  // Blocks come first; a chunk is either all blocks or none.
  PackedEdgePairs packed;
  if (first < held.blocks * EdgePairs::kLanes) {
    count = std::min(count, held.blocks * EdgePairs::kLanes - first);
    const std::size_t block = first / EdgePairs::kLanes, end = block + count / EdgePairs::kLanes;
    for (; held.packed < end; ++held.packed) {
      packEdgePairs(tree, part, pairs.subspan(held.packed * EdgePairs::kLanes).first<EdgePairs::kLanes>(),
                    edgePairKernels_, edgePairs_[held.firstBlock + held.packed]);
      spend(EdgePairs::kLanes);
    }
    packed = {std::span<const EdgePairs>(edgePairs_).subspan(held.firstBlock + block, end - block),
              edgePairKernels_};
  }
  const ContactReach within{pairsReach_, contactTurn(pairsReach_, scene.metric.radius)};
  const RigidTransform bodyFromPart = (other.worldFromPart.inverse() * look_.pose).normalized();
  const ContactResult result = testContacts({tree, part, bodyFromPart, pairsReach_}, within,
                                            pairs.subspan(first, count), found_, packed);
  spend((packed.blocks.empty() ? kWorkOfPairTest : 1) * count + result.count);
  Surroundings& around = look_.around;
  if (look_.from && around.onWay > 0.0) {
    const PairPassage passage(tree, part, wayOf(scene, other, *look_.from, look_.pose),
                              kClearOnWay * pairsReach_);
    around.onWay = std::min(around.onWay, passage.leastOf(pairs.subspan(first, count)));
    spend(kWorkOfPassage * count);
  }
  around.distance = std::min(around.distance, result.distanceBound());
  around.completeTo = std::min(around.completeTo, result.completeTo);
  takeContacts(other, held.body, std::span(found_).first(result.count));
  look_.pair += count;
}

void ContactFinder::takeContacts(const ServoScene::Body& other, std::uint32_t body,
                                 std::span<const ContactPair> contacts) noexcept {
  const Placement placement(other.worldFromPart);
  for (const ContactPair& pair : contacts) {
    if (!thinning_.add({placement.inWorld(pair), body})) look_.around.completeTo = 0.0;
  }
}

bool ContactFinder::testMany(const ServoScene& scene, const HeldBody& held) noexcept {
  const ServoScene::Body& other = scene.bodies[held.body];
  ManyPairs& many = held.prepared != nullptr ? *held.prepared : many_[held.many].pairs;
  Surroundings& around = look_.around;
  if (look_.pair == 0) {
    ManyPairs::Asked asked = askedAmongThousands(
        scene, other, (other.worldFromPart.inverse() * look_.pose).normalized(), pairsReach_, askedReach_);
    if (look_.from) {
      const MotionBudget motion = motionOf(scene, *look_.from, look_.pose);
      const double near = scene.metric.radius + pairsReach_ + 2.0 * holds_.travel + stretchTravel_;
      asked.way = wayOf(scene, other, *look_.from, look_.pose);
      asked.bendFromPart = bendOf(motion.turn, near) + kBendOfShift * motion.turn * motion.travel;
      asked.enough = kClearOnWay * pairsReach_ + around.deviation;
    }
    many.begin(asked);
    look_.pair = 1;
  }
  for (;;) {
    std::uint64_t left = workLeft();
    const std::uint64_t before = left;
    std::size_t count = 0;
    const std::optional<ManyPairs::Found> found = many.goOn(left, found_, count);
    spend(before - left);
    takeContacts(other, held.body, std::span(found_).first(count));
    if (found) {
      around.distance = std::min(around.distance, found->least);
      around.completeTo = std::min(around.completeTo, many.need());
      if (look_.from) around.onWay = std::min(around.onWay, found->leastOnWay);
      return true;
    }
    if (workLeft() == 0) return false;
  }
}

bool ContactFinder::testSurface(const ServoScene& scene, HeldBody& held) noexcept {
  const ServoScene::Body& other = scene.bodies[held.body];
  if (!look_.isTestingSurface) {
    TriangleTests::Asked asked{.scene = other.surface.get(),
                               .part = scene.moving.surface.get(),
                               .sceneFromPart = (other.worldFromPart.inverse() * look_.pose).normalized(),
                               .within = pairsReach_,
                               .held = {std::span(triangles_).subspan(held.first, held.count), held.within,
                                        motionOf(scene, pairsPose_, look_.pose).travel,
                                        motionOf(scene, held.testedPose, look_.pose).travel}};
    if (look_.from) asked.way = wayOf(scene, other, *look_.from, look_.pose);
    asked.enough = kClearOnWay * pairsReach_;
    triangleTests_.begin(asked, surfaceFound_);
    held.testedPose = look_.pose;
    look_.isTestingSurface = true;
  }
  std::uint64_t left = workLeft();
  const std::uint64_t before = left;
  const bool isDone = triangleTests_.goOn(left);
  spend(before - left);
  if (!isDone) return false;
  look_.isTestingSurface = false;
  const SurfaceContacts& result = triangleTests_.result();
  Surroundings& around = look_.around;
  around.distance = std::min(around.distance, result.lowerBound);
  around.completeTo = std::min(around.completeTo, result.completeTo);
  if (look_.from) around.onWay = std::min(around.onWay, result.leastOnWay);
  const Placement placement(other.worldFromPart);
  for (const SurfaceContact& contact : std::span(surfaceFound_).first(result.count)) {
    const ContactPair pair{contact.partPoint, contact.direction, contact.distance};
    if (!thinning_.add({placement.inWorld(pair), held.body})) around.completeTo = 0.0;
  }
  return true;
}

void ContactFinder::giveUpLook() noexcept {
  if (look_.isTestingSurface) triangleTests_.settle();
  look_.isTestingSurface = look_.isPending = false;
}

bool ContactFinder::testBodies(const ServoScene& scene) noexcept {
  if (!arranging_.isDone && !arrangePairs(scene)) return false;
  const std::span<HeldBody> held = std::span(bodies_).first(bodyCount_);
  for (; look_.body < held.size(); ++look_.body, look_.pair = 0) {
    HeldBody& body = held[look_.body];
    if (workLeft() == 0) return false;
    spend(kWorkOfBody);
    look_.around.deviation = std::max(look_.around.deviation, scene.deviation(scene.bodies[body.body]));
    if (scene.bodies[body.body].surface) continue;
    if (body.prepared != nullptr || body.many < kMaxMany) {
      if (!testMany(scene, body)) return false;
      continue;
    }
    while (look_.pair < body.count) {
      if (workLeft() == 0) return false;
      testPairs(scene, body, look_.pair, std::min(kChunk, body.count - look_.pair));
    }
  }
  for (; look_.surface < held.size(); ++look_.surface) {
    HeldBody& body = held[look_.surface];
    if (!scene.bodies[body.body].surface) continue;
    if (workLeft() == 0 || !testSurface(scene, body)) return false;
  }
  return true;
}

Surroundings ContactFinder::find(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                                 double reach, double way, std::span<BodyContact> out,
                                 const Step* step) noexcept {
  const Surroundings around = look(tracked, worldFromPart, reach, way, out, step);
  if (around.isPending) return around;
  isBlind_ = (isBlind_ || isFirstLook_) && !(around.distance > 0.0);
  isFirstLook_ = false;
  return around;
}

Surroundings ContactFinder::look(const TrackedScene& tracked, const RigidTransform& worldFromPart,
                                 double reach, double way, std::span<BodyContact> out,
                                 const Step* step) noexcept {
  const ServoScene& scene = *tracked.scene;
  const glm::dvec3 centre = worldFromPart.applyToPoint(scene.centreInPart);
  const bool isSame = look_.isPending && isHoldingPairs_ && reach == look_.reach &&
                      worldFromPart == look_.pose && arePreparedCurrent(tracked);
  const Surroundings pending{.isPending = true};
  if (!isSame) {
    giveUpLook();
    if (workLeft() == 0) return pending;
    if (isFirstLook_) {
      tickTravel_ = motionOf(scene, tickPose_, worldFromPart).travel;
      tickPose_ = worldFromPart;
    }
    if (!holdsFor(tracked, worldFromPart, reach)) {
      const Gathered outcome = gatherPairs(tracked, worldFromPart, reach, way, step);
      if (outcome == Gathered::Postponed) return pending;
      if (outcome != Gathered::Held) return {};
      noteCrowd();
    }
    look_ = {.pose = worldFromPart,
             .reach = reach,
             .around = {.distance = pairsReach_, .completeTo = pairsReach_, .reach = pairsReach_}};
    if (step != nullptr && step->isLong && spentOfHeld(scene, step->from) <= 1.0) {
      look_.from = step->from;
      look_.around.onWay = pairsReach_;
    }
    // With no body near, nothing is nearer than the distance searched, room for motion included.
    if (bodyCount_ == 0)
      look_.around.distance += holds_.travel - motionOf(scene, pairsPose_, worldFromPart).travel;
    thinning_.begin(centre, scene.metric.principalFromWorld(worldFromPart), scene.metric);
  }
  look_.isPending = !testBodies(scene);
  if (look_.isPending) return pending;
  const ContactThinning::Kept kept = thinning_.keep(out);
  look_.around.count = kept.count;
  look_.around.completeTo = std::min(look_.around.completeTo, kept.completeTo);
  return look_.around;
}

}  // namespace nearfit
