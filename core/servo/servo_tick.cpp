#include "core/servo/servo_tick.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/haptics/spring_law.h"
#include "core/math/finite.h"
#include "core/servo/servo_faults.h"

namespace nearfit {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) noexcept {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Zero for tiny velocities: one that decays at rest would stay among the denormals, where
/// arithmetic is slow.
glm::dvec3 withoutTraces(const glm::dvec3& velocity) noexcept {
  return glm::length(velocity) < 1e-100 ? glm::dvec3(0.0) : velocity;
}

/// Mean velocity between two poses, at a point that both carry.
Twist twistBetween(const RigidTransform& from, const RigidTransform& to, const glm::dvec3& centre,
                   double period) noexcept {
  return {(to.applyToPoint(centre) - from.applyToPoint(centre)) / period,
          turnBetween(from.rotation, to.rotation) / period};
}

/// Halvings by which it is found how far what is felt may come back: to a four-thousandth of the way.
constexpr int kReturnHalvings = 12;
/// Ticks after which a part that is still behind is long behind.
constexpr std::uint32_t kLongBehind = 16;

/// Work that the proxy may do once the wrench is on its way. A device of a higher rate leaves less time for it;
/// a period measured a little longer or shorter must not change what is done. A part that has been behind for long
/// gets half as much again, and among thousands of pairs twice as much: a nut that stays behind loses turns.
std::uint64_t workOfMovingOn(double period, bool isLongBehind, bool isAmongThousands) noexcept {
  const std::uint64_t halves = !isLongBehind ? 2 : isAmongThousands ? 4 : 3;
  const std::uint64_t usual = ContactFinder::kUsualWork * halves / 2;
  constexpr double kHalfPeriod = 0.6e-3, kQuarterPeriod = 0.35e-3;
  return usual / (period > kHalfPeriod ? 1U : period > kQuarterPeriod ? 2U : 4U);
}

void clearOutputs(ServoSnapshot& snapshot) noexcept {
  snapshot.wrench = snapshot.unclampedWrench = snapshot.deviceWrench = Wrench{};
  snapshot.guidance = Wrench{};
  snapshot.distance = std::numeric_limits<double>::infinity();
  snapshot.queryTime = snapshot.proxyTime = snapshot.wrenchTime = 0.0;
  snapshot.work = 0;
  snapshot.lmdCount = snapshot.storedLmds = snapshot.lateBodies = 0;
  snapshot.subSteps = snapshot.shortenedSteps = snapshot.refusedSteps = 0;
  snapshot.constraintCount = snapshot.contactCount = snapshot.storedContacts = snapshot.overlappingCount = 0;
  snapshot.isTruncated = snapshot.isClamped = snapshot.isWaiting = snapshot.isStarved = snapshot.isBehind =
      snapshot.isCrowded = false;
  snapshot.areJointsContradictory = snapshot.isOverlapUnknown = false;
  snapshot.jointCount = 0;
  snapshot.offJoints = {};
  snapshot.coupling = {};
  snapshot.springShares = {};
  snapshot.areaCount = 0;
}

}  // namespace

void ServoTick::reset() noexcept {
  mapper_ = {};
  periodMeter_ = PeriodMeter{};
  passivity_.reset();
  conditioner_ = {};
  partStep_ = {};
  held_ = {};
  guidance_.reset();
  pull_ = {};
  springShares_ = {};
  hasPose_ = false;
  shownReach_.reset();
  isToBeShown_ = false;
  fault_ = ServoFault::None;
}

void ServoTick::run(const TrackedScene& tracked, const ServoParameters& parameters, const HandleInput& input,
                    double period, ServoSnapshot& snapshot) noexcept {
  feel(tracked, parameters, input, period, snapshot);
  show(tracked, parameters, snapshot);
}

void ServoTick::feel(const TrackedScene& tracked, const ServoParameters& parameters, const HandleInput& input,
                     double period, ServoSnapshot& snapshot) noexcept {
  const Clock::time_point begin = Clock::now();
  const ServoScene& scene = *tracked.scene;
  const HapticSettings& settings = parameters.haptics;
  clearOutputs(snapshot);
  period_ = period;
  isTorqueFelt_ = input.isTorqueFelt;
  isToBeShown_ = false;
  snapshot.moving = scene.moving.id;
  snapshot.mode = settings.mode;
  snapshot.isClutched = input.isClutched;
  snapshot.grip = input.grip;
  if (scene.moving.id != moving_) {
    hasPose_ = false;
    shownReach_.reset();
  }
  moving_ = scene.moving.id;
  if (fault_ == ServoFault::None) fault_ = faultOfInput(settings, parameters.limits, input.pose, period);
  if (!hasPose_) handle_.pose = part_.pose = scene.moving.worldFromPart;

  DeviceLimits limits = limitsAtHandle(parameters.limits, settings.mapping.scale);
  // A torque that is not rendered gives the hand no energy back.
  if (!isTorqueFelt_) limits.maxTorque = 0.0;
  const Tick tick{{tracked, scene, settings, snapshot}, limits, period};
  if (fault_ == ServoFault::None) {
    periodMeter_.add(period);
    // The pivot is the centre of mass, about which torques are.
    const RigidTransform device = input.pose.normalized();
    if (!hasPose_)
      mapper_.engageAt(device, input.hasOwnFrame ? part_.pose.normalized() : device, scene.centreInPart);
    const bool hasNewMode = hasPose_ && settings.mode != mode_;
    if (hasNewMode || (input.returnsToPart && hasPose_)) letGo(device, scene.centreInPart);
    if (hasNewMode && conditioner_.isEngaged()) conditioner_.engage();
    if (hasNewMode) springShares_ = {};
    takePose(tick, mapper_.map(device, input.isClutched, settings.mapping));
    const bool isFelt = input.isArmed && !input.isClutched;
    if (isFelt != conditioner_.isEngaged()) isFelt ? conditioner_.engage() : conditioner_.disengage();
    LimitedCoupling felt;
    if (settings.mode == HapticMode::Proxy)
      felt = feelProxy(tick);
    else
      felt.wanted = felt.rendered = feelSprings(tick);
    snapshot.guidance = {pull_.force, pull_.torque};
    const Wrench damping = passivity_.damping(limits, period);
    for (Wrench* wrench : {&felt.wanted, &felt.rendered}) {
      wrench->force += pull_.force + damping.force;
      wrench->torque += pull_.torque + damping.torque;
      // Not merely clamped: it would count as a force at its limit. Also of a device that senses no turning (an omega.3).
      if (!(limits.maxTorque > 0.0)) wrench->torque = glm::dvec3(0.0);
    }
    const bool isUsable = isFinite(felt.wanted.force) && isFinite(felt.wanted.torque) &&
                          isFinite(felt.rendered.force) && isFinite(felt.rendered.torque);
    if (fault_ == ServoFault::None && !isUsable) fault_ = ServoFault::WrenchNotFinite;
    if (fault_ == ServoFault::None) send(tick, felt, input);
  }
  if (fault_ != ServoFault::None) {
    conditioner_ = {};
    held_ = {};
  }
  snapshot.handle = handle_.pose;
  writePose(tick);
  snapshot.period = periodMeter_.heldPeriod();
  snapshot.energyToHand = passivity_.energyToHand();
  snapshot.fault = fault_;
  snapshot.wrenchTime = secondsSince(begin);
}

void ServoTick::letGo(const RigidTransform& device, const glm::dvec3& centreInPart) noexcept {
  // At rest: the way back is not motion of the hand.
  handle_ = {part_.pose.normalized(), {}};
  mapper_.engageAt(device, handle_.pose, centreInPart);
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
  coupling_ =
      boundedCoupling(tick.settings.coupling, tick.limits, tick.scene.metric, periodMeter_.heldPeriod());
  mass_ = feltBody(tick.settings.weight, tick.scene.mass, tick.limits.maxForce);
  if (!hasPose_) {
    handle_ = {handle, {}};
    pull_ = pullOfGuidance(tick);
    part_ = {isProxy ? tick.scene.moving.worldFromPart.normalized() : handle, {}};
    felt_ = part_;
    isFeltAhead_ = false;
    partStep_ = {};
    partShift_ = glm::dvec3(0.0);
    proxy_.place(part_.pose);
    conditioner_.engage();
    hasPose_ = true;
  } else {
    const RigidTransform before = handle_.pose;
    handle_ = smoothed(handle_, handle, tick.scene.centreInPart, tick.period);
    pull_ = pullOfGuidance(tick);
    account(tick, before);
    // With springs the part may be anywhere, so what it overlaps is not known.
    if (isProxy && mode_ != HapticMode::Proxy) proxy_.place(part_.pose);
  }
  mode_ = tick.settings.mode;
}

GuidancePull ServoTick::pullOfGuidance(const Tick& tick) noexcept {
  const GuidancePath* path = tick.scene.guidance.get();
  if (path == nullptr) return {};
  const GuidanceSettings settings = boundedGuidance(path->settings(), tick.limits, periodMeter_.heldPeriod());
  return guidance_.follow(*path, settings,
                          {handle_.pose.applyToPoint(tick.scene.centreInPart), handle_.pose.rotation});
}

void ServoTick::movePart(const Subject& subject, const RigidTransform& pose) noexcept {
  partStep_ = twistBetween(part_.pose, pose, subject.scene.centreInPart, period_);
  partShift_ = period_ * partStep_.linear;
  part_ = smoothed(part_, pose, subject.scene.centreInPart, period_);
}

void ServoTick::writePose(const Subject& subject) const noexcept {
  subject.snapshot.proxy = part_.pose;
  subject.snapshot.centre = part_.pose.applyToPoint(subject.scene.centreInPart);
}

Wrench ServoTick::feelSprings(const Tick& tick) noexcept {
  movePart(tick, handle_.pose);
  felt_ = part_;
  SpringSum sum{tick.settings.springs};
  // The last tick's: springs that never pull are not known before their damping is.
  sum.parameters.damping *= springShares_.damping;
  findMinima(tick, 1.0, &sum);
  const SpringShares bounded =
      boundedSprings(sum.directions, tick.settings.springs, tick.limits, periodMeter_.heldPeriod());
  springShares_ = risenShares(springShares_, bounded, tick.period);
  // Shares rise for a while after the last spring; then nothing is held back.
  tick.snapshot.springShares = sum.directions.alongOneLine() > 0.0 ? springShares_ : SpringShares{};
  showOverlaps(tick);
  tick.snapshot.isOverlapUnknown =
      tick.scene.moving.geometry != nullptr && !(tick.tracked.clearanceSpent(part_.pose) < 1.0);
  return {mass_.weight + springShares_.wrench * sum.wrench.force, springShares_.wrench * sum.wrench.torque};
}

bool ServoTick::areBodiesPlaced(const Tick& tick) const noexcept {
  bool arePlaced = true;
  tick.tracked.visitNear(part_.pose, tick.settings.springs.cutoff,
                         [&](std::uint32_t body, const TrackedScene::Near*) {
                           arePlaced = arePlaced && isPose(tick.scene.bodies[body].worldFromPart);
                         });
  return arePlaced;
}

LimitedCoupling ServoTick::feelProxy(const Tick& tick) noexcept {
  const ServoScene& scene = tick.scene;
  tick.snapshot.coupling = coupling_;
  isToBeShown_ = true;
  RigidTransform felt = handle_.pose;
  if (scene.moving.geometry != nullptr) {
    const BodyMotion target = freeStep(mass_, coupling_, scene.metric, scene.centreInPart, handle_,
                                       {part_.pose, partStep_}, tick.period);
    const Clock::time_point begin = Clock::now();
    // The target is not normalised: a free part must match the hand bit for bit, so that there is no force.
    if (!areBodiesPlaced(tick)) {
      fault_ = ServoFault::PoseNotFinite;
    } else if (isPose(target.pose)) {
      const double scale = isTorqueFelt_ ? turnScale(coupling_, scene.metric) : kTurnScaleWithoutTorque;
      proxy_.begin(tick.tracked, target.pose, tick.settings.proxy, scale);
      // Among thousands of pairs no look ends within it.
      proxy_.advance(tick.tracked, proxy_.isAmongThousands() ? 0 : kWorkOfFeel, ContactFinder::Excess::None);
      proxy_.feel(tick.tracked);
    } else {
      fault_ = ServoFault::WrenchNotFinite;
    }
    tick.snapshot.proxyTime = secondsSince(begin);
    felt = proxy_.feltPose();
  }
  felt_ = smoothed(felt_, withoutLeap(tick, felt), scene.centreInPart, tick.period);
  const RigidTransform& proved = proxy_.pose();
  isFeltAhead_ = scene.moving.geometry != nullptr &&
                 (felt_.pose.translation != proved.translation || felt_.pose.rotation != proved.rotation);
  return limitedCoupling(coupling_, scene.metric, scene.centreInPart, handle_, felt_, tick.limits);
}

RigidTransform ServoTick::withoutLeap(const Tick& tick, const RigidTransform& felt) noexcept {
  returnEnergy_ = std::min(kMaxReturnEnergy, returnEnergy_ + kReturnPower * tick.period);
  if (!isFeltAhead_) return felt;
  const glm::dvec3& centre = tick.scene.centreInPart;
  const auto energyAt = [&](const RigidTransform& pose) {
    return storedEnergy(coupling_, tick.scene.metric, centre, handle_.pose, pose, tick.limits);
  };
  const glm::dvec3 from = felt_.pose.applyToPoint(centre), to = felt.applyToPoint(centre);
  const auto at = [&](double share) {
    const glm::dquat rotation = glm::normalize(glm::slerp(felt_.pose.rotation, felt.rotation, share));
    return RigidTransform{rotation, from + share * (to - from) - rotation * centre};
  };
  const double before = energyAt(felt_.pose);
  RigidTransform taken = felt;
  if (energyAt(felt) - before > returnEnergy_) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < kReturnHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (energyAt(at(middle)) - before > returnEnergy_ ? high : low) = middle;
    }
    taken = at(low);
  }
  returnEnergy_ -= std::clamp(energyAt(taken) - before, 0.0, returnEnergy_);
  return taken;
}

void ServoTick::moveOn(const Subject& subject) noexcept {
  if (subject.scene.moving.geometry == nullptr) {
    movePart(subject, handle_.pose);
  } else {
    const Clock::time_point begin = Clock::now();
    if (fault_ == ServoFault::None)
      proxy_.advance(subject.tracked,
                     workOfMovingOn(period_, ticksBehind_ > kLongBehind, proxy_.isAmongThousands()),
                     ContactFinder::Excess::ToGather);
    subject.snapshot.proxyTime += secondsSince(begin) - proxy_.queryTime();
    subject.snapshot.queryTime += proxy_.queryTime();
    ticksBehind_ = proxy_.account().isBehind ? ticksBehind_ + 1 : 0;
    movePart(subject, proxy_.pose());
  }
  writePose(subject);
}

void ServoTick::account(const Tick& tick, const RigidTransform& handleBefore) noexcept {
  const glm::dvec3& centre = tick.scene.centreInPart;
  HandInterval interval;
  interval.held = held_;
  interval.shift = handle_.pose.applyToPoint(centre) - handleBefore.applyToPoint(centre);
  interval.turn = turnBetween(handleBefore.rotation, handle_.pose.rotation);
  interval.duration = tick.period;
  interval.weight = mass_.weight;
  interval.partShift = partShift_;
  double stored = PassivityController::kMaxDebt;
  if (tick.settings.mode == HapticMode::Proxy) {
    stored = storedEnergy(coupling_, tick.scene.metric, centre, handle_.pose, felt_.pose, tick.limits) +
             kineticEnergy(mass_, tick.scene.metric, {part_.pose, partStep_}) + pull_.energy;
  }
  passivity_.observe(interval, tick.limits, stored);
}

void ServoTick::send(const Tick& tick, const LimitedCoupling& felt, const HandleInput& input) noexcept {
  const ConditionedWrench sent =
      conditioner_.condition(felt.rendered, input.age, tick.period, tick.limits, input.patience);
  const bool isLimited =
      felt.rendered.force != felt.wanted.force || felt.rendered.torque != felt.wanted.torque;
  tick.snapshot.unclampedWrench = felt.wanted;
  tick.snapshot.wrench = sent.wrench;
  tick.snapshot.isClamped = isLimited || sent.isClamped;
  tick.snapshot.deviceWrench = wrenchOnDevice(sent.wrench, tick.settings.mapping);
  held_ = sent.wrench;
}

}  // namespace nearfit
