#include <algorithm>
#include <chrono>
#include <limits>
#include <span>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/haptics/spring_law.h"
#include "core/servo/servo_tick.h"

/// The part of ServoTick that finds minima, to show them or as springs, and describes the proxy.
namespace nearfit {
namespace {

/// Allowance for minima that are shown in a tick in which contacts have taken so much work: they share its time.
MinimaAllowance shownBeside(std::uint64_t contactWork) noexcept {
  constexpr std::uint64_t kFull = ContactFinder::kUsualWork;
  const std::uint64_t left = kFull - std::min(contactWork, kFull);
  const auto between = [left](std::uint64_t least, std::uint64_t most) {
    return least + (most - least) * left / kFull;
  };
  const MinimaAllowance &least = MinimaFinder::kShownInFullTick, &most = MinimaFinder::kShown;
  return {between(least.search, most.search), between(least.merge, most.merge)};
}

/// Square of the distance of a point to a box [m^2]; 0 within it.
double squaredDistance(const Aabb& box, const glm::dvec3& point) noexcept {
  const glm::dvec3 way = point - glm::clamp(point, box.lower, box.upper);
  return glm::dot(way, way);
}

/// The part of a moving group that a contact is of: contacts are known by their points alone. It is the one whose box the
/// point is in; of several such parts, that of the nearest minimum with the same other part. O(members + minima).
PartId memberAtContact(const ServoSnapshot& snapshot, std::span<const BodyMember> members,
                       const RigidTransform& worldFromMoving, const SnapshotContact& contact) noexcept {
  const glm::dvec3 point = worldFromMoving.inverse().applyToPoint(contact.point);
  PartId part = snapshot.moving;
  double nearestBox = std::numeric_limits<double>::infinity();
  for (const BodyMember& member : members) {
    const double squared = squaredDistance(member.bounds, point);
    if (!(squared < nearestBox)) continue;
    nearestBox = squared;
    part = member.id;
  }
  const auto isIn = [&](PartId id) {
    const auto member = std::ranges::find(members, id, &BodyMember::id);
    return member != members.end() && squaredDistance(member->bounds, point) <= nearestBox;
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = 0; i < snapshot.storedLmds; ++i) {
    const SnapshotLmd& minimum = snapshot.lmds[i];
    if (minimum.other != contact.other) continue;
    const glm::dvec3 way = minimum.lmd.partPoint - contact.point;
    const double squared = glm::dot(way, way);
    if (!(squared < nearest) || !isIn(minimum.part)) continue;
    nearest = squared;
    part = minimum.part;
  }
  return part;
}

}  // namespace

void ServoTick::show(const TrackedScene& tracked, const ServoParameters& parameters,
                     ServoSnapshot& snapshot) noexcept {
  if (!isToBeShown_) return;
  isToBeShown_ = false;
  const Subject subject{tracked, *tracked.scene, parameters.haptics, snapshot};
  moveOn(subject);
  showMinima(subject);
  describeProxy(subject);
  snapshot.fault = fault_;
}

MinimaFinder::Result ServoTick::findMinima(const Subject& subject, double share,
                                           SpringSum* springs) noexcept {
  const auto begin = std::chrono::steady_clock::now();
  const glm::dvec3 centre = part_.pose.applyToPoint(subject.scene.centreInPart);
  const double cutoff = share * subject.settings.springs.cutoff;
  // With springs nothing keeps the part from passing through, so no distance can be relied on.
  const double apart = springs == nullptr ? proxy_.distance() : 0.0;
  const MinimaAllowance allowance = springs == nullptr               ? shownBeside(proxy_.work())
                                    : springs->parameters.onePerArea ? MinimaFinder::kFeltByArea
                                                                     : MinimaFinder::kFelt;
  const MinimaFinder::Result result =
      minima_.find(subject.tracked, part_.pose, cutoff, apart, allowance, [&](std::span<const Lmd> lmds) {
        if (springs == nullptr) return;
        const Wrench wrench = springWrench(lmds, springs->parameters, centre, part_.twist);
        springs->wrench.force += wrench.force;
        springs->wrench.torque += wrench.torque;
        springs->directions.add(lmds, springs->parameters, centre);
      });
  if (result.isPoseBad) fault_ = ServoFault::PoseNotFinite;
  minima_.write(subject.snapshot);
  if (share < 1.0) subject.snapshot.isTruncated = true;
  subject.snapshot.areaCount = result.areas;
  subject.snapshot.lateBodies += result.lateBodies;
  subject.snapshot.work += result.work;
  subject.snapshot.queryTime +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  // Of solid bodies that are apart, the distance of the nearest minimum is the distance.
  if (!subject.scene.hasSurfaces())
    proxy_.noteDistance(std::min({result.distance, result.completeTo, cutoff}));
  return result;
}

void ServoTick::showMinima(const Subject& subject) noexcept {
  const double cutoff = subject.settings.springs.cutoff;
  const MinimaFinder::Result result = findMinima(subject, shownReach_.share(), nullptr);
  // A minimum that is missing may be nearer than those found, but no nearer than either bound.
  const double known = std::max(result.completeTo, proxy_.distance());
  subject.snapshot.isDistanceBound = known < std::min(result.distance, cutoff);
  if (subject.snapshot.isDistanceBound) subject.snapshot.distance = known;
  const double nearest = result.completeTo < std::min(result.distance, cutoff)
                             ? std::min(result.distance, distanceOfContacts(subject))
                             : result.distance;
  shownReach_.observe(result.work, nearest / cutoff);
}

double ServoTick::distanceOfContacts(const Subject& subject) const noexcept {
  const double known = proxy_.distance();
  return known < kContactReach * subject.settings.proxy.margin ? known
                                                               : std::numeric_limits<double>::infinity();
}

void ServoTick::describeProxy(const Subject& subject) noexcept {
  ServoSnapshot& snapshot = subject.snapshot;
  const ProxyAccount& account = proxy_.account();
  snapshot.subSteps = account.subSteps;
  snapshot.shortenedSteps = account.shortenedSteps;
  snapshot.refusedSteps = account.refusedSteps;
  snapshot.constraintCount = account.constraintCount;
  snapshot.isWaiting = account.isWaiting;
  snapshot.isStarved = account.isStarved;
  snapshot.isBehind = account.isBehind;
  snapshot.isCrowded = proxy_.isCrowded();
  snapshot.lateBodies += proxy_.lateBodies();
  snapshot.work += proxy_.work();
  const JointSet& joints = subject.scene.joints;
  snapshot.areJointsContradictory = subject.scene.areJointsContradictory;
  snapshot.jointCount = static_cast<std::uint32_t>(joints.size());
  if (!joints.isEmpty()) snapshot.offJoints = joints.residual(part_.pose);
  // Contacts hold indices into the scene that they were found in.
  if (subject.scene.moving.geometry == nullptr || fault_ != ServoFault::None) return;
  snapshot.contactCount = static_cast<std::uint32_t>(proxy_.contacts().size());
  for (const ProxyContact& holding : proxy_.contacts()) {
    if (snapshot.storedContacts == ServoSnapshot::kMaxContacts) break;
    const ContactPair& pair = holding.contact.pair;
    SnapshotContact& contact = snapshot.contacts[snapshot.storedContacts++];
    contact = {pair.point, pair.direction, coupling_.stiffness * holding.push,
               subject.scene.bodies[holding.contact.body].id, snapshot.moving};
    if (!subject.scene.members.empty()) {
      contact.part = memberAtContact(snapshot, subject.scene.members, part_.pose, contact);
    }
  }
  showOverlaps(subject);
}

void ServoTick::showOverlaps(const Subject& subject) noexcept {
  ServoSnapshot& snapshot = subject.snapshot;
  const Clearance& clearance = subject.tracked.clearance;
  if (!clearance.overlapping || subject.scene.moving.geometry == nullptr) return;
  snapshot.overlappingCount = static_cast<std::uint32_t>(clearance.overlapping->size());
  const std::size_t shown = std::min(clearance.overlapping->size(), ServoSnapshot::kMaxOverlapping);
  for (std::size_t i = 0; i < shown; ++i)
    snapshot.overlapping[i] = subject.scene.bodies[(*clearance.overlapping)[i]].id;
}

}  // namespace nearfit
