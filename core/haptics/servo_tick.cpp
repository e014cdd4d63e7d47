#include "core/haptics/servo_tick.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/haptics/servo_faults.h"
#include "core/haptics/spring_law.h"

namespace nearfit {
namespace {

using Clock = std::chrono::steady_clock;

bool isFinite(const glm::dvec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

double secondsSince(Clock::time_point begin) noexcept {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A velocity that decays at rest would end, for good, among the denormals, where arithmetic is slow.
glm::dvec3 withoutTraces(const glm::dvec3& velocity) noexcept {
  return glm::length(velocity) < 1e-100 ? glm::dvec3(0.0) : velocity;
}

/// Mean velocity from one pose to the next, of a point that both carry.
Twist twistBetween(const RigidTransform& from, const RigidTransform& to, const glm::dvec3& centre,
                   double period) noexcept {
  return {(to.applyToPoint(centre) - from.applyToPoint(centre)) / period,
          turnBetween(from.rotation, to.rotation) / period};
}

void clearOutputs(ServoSnapshot& snapshot) noexcept {
  snapshot.wrench = snapshot.unclampedWrench = snapshot.deviceWrench = Wrench{};
  snapshot.distance = std::numeric_limits<double>::infinity();
  snapshot.queryTime = snapshot.proxyTime = 0.0;
  snapshot.lmdCount = snapshot.storedLmds = snapshot.lateBodies = 0;
  snapshot.subSteps = snapshot.shortenedSteps = snapshot.refusedSteps = 0;
  snapshot.constraintCount = snapshot.contactCount = snapshot.storedContacts = snapshot.releasedCount = 0;
  snapshot.isTruncated = snapshot.isClamped = snapshot.isWaiting = snapshot.isStarved = false;
  snapshot.coupling = {};
}

}  // namespace

void ServoTick::reset() noexcept {
  mapper_ = {};
  periodMeter_ = PeriodMeter{};
  passivity_.reset();
  conditioner_ = {};
  partStep_ = {};
  held_ = {};
  hasPose_ = false;
  shownShare_ = 1.0;
  fault_ = ServoFault::None;
}

void ServoTick::run(const TrackedScene& tracked, const ServoParameters& parameters, const HandleInput& input,
                    double period, ServoSnapshot& snapshot) noexcept {
  const ServoScene& scene = *tracked.scene;
  const HapticSettings& settings = parameters.haptics;
  clearOutputs(snapshot);
  snapshot.moving = scene.moving.id;
  snapshot.mode = settings.mode;
  if (scene.moving.id != moving_) {
    hasPose_ = false;
    shownShare_ = 1.0;
  }
  moving_ = scene.moving.id;
  if (fault_ == ServoFault::None) fault_ = faultOfInput(settings, parameters.limits, input.pose, period);
  if (!hasPose_) handle_.pose = part_.pose = scene.moving.worldFromPart;

  const DeviceLimits limits = limitsAtHandle(parameters.limits, settings.mapping.scale);
  const Tick tick{tracked, scene, settings, limits, period, snapshot};
  if (fault_ == ServoFault::None) {
    periodMeter_.add(period);
    // Turned about the centre of mass, about which torques are.
    if (!hasPose_) mapper_.engageAt(input.pose.normalized(), input.pose.normalized(), scene.centreInPart);
    takePose(tick, mapper_.map(input.pose.normalized(), input.isClutched, settings.mapping));
    if (input.isClutched == conditioner_.isEngaged())
      input.isClutched ? conditioner_.disengage() : conditioner_.engage();
    Wrench wrench = settings.mode == HapticMode::Proxy ? feelProxy(tick) : feelSprings(tick);
    const Wrench damping = passivity_.damping(limits, period);
    wrench.force += damping.force;
    wrench.torque += damping.torque;
    const bool isUsable = isFinite(wrench.force) && isFinite(wrench.torque);
    if (fault_ == ServoFault::None && !isUsable) fault_ = ServoFault::WrenchNotFinite;
    if (fault_ == ServoFault::None) send(tick, wrench, input.age);
  }
  if (fault_ != ServoFault::None) {
    conditioner_ = {};
    held_ = {};
  }
  snapshot.handle = handle_.pose;
  snapshot.proxy = part_.pose;
  snapshot.centre = part_.pose.applyToPoint(scene.centreInPart);
  snapshot.period = periodMeter_.period();
  snapshot.energyToHand = passivity_.energyToHand();
  snapshot.fault = fault_;
}

BodyMotion ServoTick::smoothed(const BodyMotion& before, const RigidTransform& pose, const glm::dvec3& centre,
                               double period) const noexcept {
  const Twist now = twistBetween(before.pose, pose, centre, period);
  const double share = period / (kVelocityTimeConstant + period);
  return {pose,
          {withoutTraces(before.twist.linear + share * (now.linear - before.twist.linear)),
           withoutTraces(before.twist.angular + share * (now.angular - before.twist.angular))}};
}

void ServoTick::takePose(const Tick& tick, const RigidTransform& handle) noexcept {
  const bool isProxy = tick.settings.mode == HapticMode::Proxy;
  coupling_ = boundedCoupling(tick.settings.coupling, tick.limits, tick.scene.metric, periodMeter_.period());
  felt_ = feltBody(tick.settings.weight, tick.scene.mass, tick.limits.maxForce);
  if (!hasPose_) {
    handle_ = {handle, {}};
    part_ = {isProxy ? tick.scene.moving.worldFromPart.normalized() : handle, {}};
    partStep_ = {};
    partShift_ = glm::dvec3(0.0);
    proxy_.place(part_.pose);
    conditioner_.engage();
    hasPose_ = true;
  } else {
    const RigidTransform before = handle_.pose;
    handle_ = smoothed(handle_, handle, tick.scene.centreInPart, tick.period);
    account(tick, before);
    // Springs let the part be anywhere: what it overlaps there is not known.
    if (isProxy && mode_ != HapticMode::Proxy) proxy_.place(part_.pose);
  }
  mode_ = tick.settings.mode;
}

void ServoTick::movePart(const Tick& tick, const RigidTransform& pose) noexcept {
  partStep_ = twistBetween(part_.pose, pose, tick.scene.centreInPart, tick.period);
  partShift_ = tick.period * partStep_.linear;
  part_ = smoothed(part_, pose, tick.scene.centreInPart, tick.period);
}

std::uint64_t ServoTick::findMinima(const Tick& tick, double share, const SpringParameters* springs,
                                    Wrench& sum) noexcept {
  const Clock::time_point begin = Clock::now();
  const glm::dvec3 centre = part_.pose.applyToPoint(tick.scene.centreInPart);
  const double cutoff = share * tick.settings.springs.cutoff;
  // With springs nothing keeps the part from going through: no distance can be taken for granted.
  const double apart = springs == nullptr ? proxy_.distance() : 0.0;
  const MinimaFinder::Result result =
      minima_.find(tick.tracked, part_.pose, cutoff, apart, [&](std::span<const Lmd> lmds) {
        if (springs == nullptr) return;
        const Wrench wrench = springWrench(lmds, *springs, centre, part_.twist);
        sum.force += wrench.force;
        sum.torque += wrench.torque;
      });
  if (result.isPoseBad) fault_ = ServoFault::PoseNotFinite;
  minima_.write(tick.snapshot);
  if (share < 1.0) tick.snapshot.isTruncated = true;
  tick.snapshot.lateBodies += result.lateBodies;
  tick.snapshot.queryTime += secondsSince(begin);
  // Of bodies that have an inside and are apart, the nearest minimum is the distance.
  if (!tick.scene.hasSurfaces()) proxy_.noteDistance(std::min({result.distance, result.completeTo, cutoff}));
  return result.work;
}

Wrench ServoTick::feelSprings(const Tick& tick) noexcept {
  movePart(tick, handle_.pose);
  Wrench sum{felt_.weight, glm::dvec3(0.0)};
  findMinima(tick, 1.0, &tick.settings.springs, sum);
  return sum;
}

Wrench ServoTick::feelProxy(const Tick& tick) noexcept {
  const ServoScene& scene = tick.scene;
  tick.snapshot.coupling = coupling_;
  if (scene.moving.geometry == nullptr) {
    movePart(tick, handle_.pose);
  } else {
    const BodyMotion target = freeStep(felt_, coupling_, scene.metric, scene.centreInPart, handle_,
                                       {part_.pose, partStep_}, tick.period);
    const Clock::time_point begin = Clock::now();
    // As it is: a free part must be where the hand is to the last bit, for there to be no force at all.
    if (isPose(target.pose))
      proxy_.follow(tick.tracked, target.pose, tick.settings.proxy);
    else
      fault_ = ServoFault::WrenchNotFinite;
    tick.snapshot.proxyTime = secondsSince(begin) - proxy_.queryTime();
    tick.snapshot.queryTime += proxy_.queryTime();
    movePart(tick, proxy_.pose());
  }
  showMinima(tick);
  describeProxy(tick);
  return couplingWrench(coupling_, scene.metric, scene.centreInPart, handle_, part_);
}

void ServoTick::showMinima(const Tick& tick) noexcept {
  constexpr double kLess = 0.7, kMore = 1.1, kLeast = 1e-3, kLittle = 1.0 / 3.0;
  Wrench none;
  const std::uint64_t work = findMinima(tick, shownShare_, nullptr, none);
  if (work > kMinimaWork) shownShare_ = std::max(kLeast, kLess * shownShare_);
  if (static_cast<double>(work) < kLittle * static_cast<double>(kMinimaWork))
    shownShare_ = std::min(1.0, kMore * shownShare_);
  // Contacts reach farther than minima that are shown, then.
  tick.snapshot.distance = std::min(tick.snapshot.distance, distanceOfContacts(tick));
}

double ServoTick::distanceOfContacts(const Tick& tick) const noexcept {
  const double known = proxy_.distance();
  const bool isShort = shownShare_ < 1.0 && known < kContactReach * tick.settings.proxy.margin;
  return isShort ? known : std::numeric_limits<double>::infinity();
}

void ServoTick::describeProxy(const Tick& tick) noexcept {
  ServoSnapshot& snapshot = tick.snapshot;
  const ProxyAccount& account = proxy_.account();
  snapshot.subSteps = account.subSteps;
  snapshot.shortenedSteps = account.shortenedSteps;
  snapshot.refusedSteps = account.refusedSteps;
  snapshot.constraintCount = account.constraintCount;
  snapshot.isWaiting = account.isWaiting;
  snapshot.isStarved = account.isStarved;
  snapshot.lateBodies += proxy_.lateBodies();
  // Contacts name bodies of the scene that they were found in.
  if (tick.scene.moving.geometry == nullptr || fault_ != ServoFault::None) return;
  snapshot.contactCount = static_cast<std::uint32_t>(proxy_.contacts().size());
  for (const ProxyContact& holding : proxy_.contacts()) {
    if (snapshot.storedContacts == ServoSnapshot::kMaxContacts) break;
    const ContactPair& pair = holding.contact.pair;
    snapshot.contacts[snapshot.storedContacts++] = {pair.point, pair.direction,
                                                    coupling_.stiffness * holding.push,
                                                    tick.scene.bodies[holding.contact.body].id};
  }
  const Clearance& clearance = tick.tracked.clearance;
  if (!clearance.overlapping) return;
  snapshot.releasedCount = static_cast<std::uint32_t>(clearance.overlapping->size());
  const std::size_t shown = std::min(clearance.overlapping->size(), ServoSnapshot::kMaxReleased);
  for (std::size_t i = 0; i < shown; ++i)
    snapshot.released[i] = tick.scene.bodies[(*clearance.overlapping)[i]].id;
}

void ServoTick::account(const Tick& tick, const RigidTransform& handleBefore) noexcept {
  const glm::dvec3& centre = tick.scene.centreInPart;
  HandInterval interval;
  interval.held = held_;
  interval.shift = handle_.pose.applyToPoint(centre) - handleBefore.applyToPoint(centre);
  interval.turn = turnBetween(handleBefore.rotation, handle_.pose.rotation);
  interval.duration = tick.period;
  interval.weight = felt_.weight;
  interval.partShift = partShift_;
  double stored = PassivityController::kMostDebt;
  if (tick.settings.mode == HapticMode::Proxy) {
    stored = storedEnergy(coupling_, tick.scene.metric, centre, handle_.pose, part_.pose, tick.limits) +
             kineticEnergy(felt_, tick.scene.metric, {part_.pose, partStep_});
  }
  passivity_.observe(interval, tick.limits, stored);
}

void ServoTick::send(const Tick& tick, const Wrench& wrench, double age) noexcept {
  const ConditionedWrench sent = conditioner_.condition(wrench, age, tick.period, tick.limits);
  tick.snapshot.unclampedWrench = wrench;
  tick.snapshot.wrench = sent.wrench;
  tick.snapshot.isClamped = sent.isClamped;
  tick.snapshot.deviceWrench = wrenchOnDevice(sent.wrench, tick.settings.mapping);
  held_ = sent.wrench;
}

}  // namespace nearfit
