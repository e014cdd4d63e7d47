#include "core/haptics/proxy.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"

namespace nearfit {
namespace {

/// Nothing is in the way of a step that ends this many margins short of what is nearest.
constexpr double kFree = 1.7;
/// Share of the distance that a step is planned to use.
constexpr double kPlanned = 0.95;
/// Share of it that a step may use: distances are rounded. What lies at the step's end proves nothing: minima
/// are the distance only where bodies do not overlap.
constexpr double kProved = 1.0 - 1e-9;
/// A step turns by this share of what contacts are relaxed by: all that it can bring nearer are there.
constexpr double kTurnShare = 0.5;
/// A step may halve the distance at most, and only down to this share of the margin, or of the distance that
/// it began with where that was less: going on by halves would end in rounding.
constexpr double kHalf = 0.5, kFloor = 1.0 / 64.0, kFloorOfFirst = 0.25;
/// Distances are not known better than this, as a fraction of the lengths involved.
constexpr double kRounding = 1e-11;
/// Nearer than this share of the margin a part is pinched: pressing alone does not bring it there.
constexpr double kPinched = 0.97;
/// A step may be this share of the distance at least.
constexpr double kLeastStep = 0.5;
/// How often a step is shortened before it is given up. On an edge, whose rounding by the margin is far
/// narrower than the hand is deep, the program's step is many times too long: where it is best tells a
/// parabola.
constexpr int kMaxShortenings = 3;
constexpr double kLeastShare = 1.0 / 64.0;
/// Of the way to a target that it was kept from, a part that has come free goes this share in a tick, besides
/// what the target moves: it does not leap.
constexpr double kSnapShare = 0.3;
/// What moves by less than this share of the margin (or of the clearance) rests: 0.1 um of 0.1 mm. The first
/// step of a tick goes on below that, so that a slow hand does not drag.
constexpr double kAtRest = 1e-3, kAtRestAtFirst = 1e-6;
/// After so many steps of a tick, one that brings less than this share of the first is left to the next tick.
constexpr std::uint32_t kWorthwhileSteps = 3;
constexpr double kWorthwhile = 0.05;
/// How hard the margin is held, against a way of so many margins into the contact: to a hundredth of it for
/// each direction that is pressed in.
constexpr double kMarginWeight = 100.0, kMostMarginWeight = 1e6;

/// The farthest that a point within `radius` of the centre moves.
double travelOf(double shift, double spin, double radius) noexcept {
  return shift + spin * radius;
}

}  // namespace

Proxy::Proxy()
    : around_(ContactFinder::kMaxContacts),
      next_(ContactFinder::kMaxContacts),
      rowContact_(ContactFinder::kMaxContacts),
      rowArm_(ContactFinder::kMaxContacts) {}

void Proxy::place(const RigidTransform& worldFromPart) noexcept {
  pose_ = worldFromPart;
  lastTarget_.reset();
  rest_ = {};
  clearedSerial_ = 0;
  isHereKnown_ = false;
  holdingCount_ = 0;
}

void Proxy::noteDistance(double distance) noexcept {
  if (isHereKnown_) here_.distance = std::max(here_.distance, distance);
}

std::span<const ProxyContact> Proxy::contacts() const noexcept {
  return std::span(holding_).first(holdingCount_);
}

double Proxy::wayTo(const Tick& tick) const noexcept {
  const Motion motion = motionTo(*tick.tracked.scene, tick.target);
  return travelOf(glm::length(motion.shift), glm::length(motion.spin), tick.tracked.scene->metric.radius);
}

Proxy::Motion Proxy::motionTo(const ServoScene& scene, const RigidTransform& target) const noexcept {
  return {target.applyToPoint(scene.centreInPart) - pose_.applyToPoint(scene.centreInPart),
          rotationVector(target.rotation * glm::conjugate(pose_.rotation))};
}

RigidTransform Proxy::moved(const ServoScene& scene, const Motion& motion) const noexcept {
  const glm::dquat rotation = glm::normalize(rotationOf(motion.spin) * pose_.rotation);
  const glm::dvec3 centre = pose_.applyToPoint(scene.centreInPart) + motion.shift;
  return {rotation, centre - rotation * scene.centreInPart};
}

bool Proxy::isCleared(const TrackedScene& tracked) noexcept {
  const Clearance& clearance = tracked.clearance;
  if (clearance.serial == 0) return false;
  if (clearance.serial == clearedSerial_) return true;
  const Motion since = motionTo(*tracked.scene, clearance.worldFromPart);
  const double travel =
      travelOf(glm::length(since.shift), glm::length(since.spin), tracked.scene->metric.radius);
  if (!(travel < clearance.distance)) return false;
  clearedSerial_ = clearance.serial;
  isHereKnown_ = false;
  floor_ = 0.0;
  rest_ = {};
  finder_.forget();
  return true;
}

void Proxy::follow(const TrackedScene& tracked, const RigidTransform& target,
                   const ProxySettings& settings) noexcept {
  account_ = {};
  queryTime_ = 0.0;
  finder_.beginTick();
  if (!isCleared(tracked)) {
    account_.isWaiting = true;
    holdingCount_ = 0;
    here_ = {};
    lastTarget_ = target;
    return;
  }
  const Tick tick{tracked, target, settings};
  if (isResting(target, settings)) return;
  // Where the work did not suffice, the lists may be ready by now.
  if (!isHereKnown_ || margin_ != settings.margin || here_.completeTo == 0.0) {
    margin_ = settings.margin;
    here_ = lookAround(tick, pose_, around_);
    isHereKnown_ = true;
    raiseFloor(tick);
  }
  holdingCount_ = 0;
  if (here_.completeTo == 0.0) {
    account_.isStarved = true;
    lastTarget_ = target;
    return;
  }
  wayLeft_ = targetMotion(tick) + std::max(kSnapShare * wayTo(tick), margin_);
  Outcome outcome = Outcome::Moved;
  while (account_.subSteps < kMaxSubSteps && outcome == Outcome::Moved)
    outcome = step(tick);
  rest_ = {target, settings, outcome == Outcome::AtRest};
  lastTarget_ = target;
}

bool Proxy::isResting(const RigidTransform& target, const ProxySettings& settings) const noexcept {
  return rest_.isAtRest && isHereKnown_ && here_.completeTo > 0.0 && settings == rest_.settings &&
         target.translation == rest_.target.translation && target.rotation == rest_.target.rotation;
}

double Proxy::targetMotion(const Tick& tick) const noexcept {
  if (!lastTarget_) return wayTo(tick);
  const glm::dvec3& centre = tick.tracked.scene->centreInPart;
  return travelOf(glm::distance(tick.target.applyToPoint(centre), lastTarget_->applyToPoint(centre)),
                  glm::length(rotationVector(tick.target.rotation * glm::conjugate(lastTarget_->rotation))),
                  tick.tracked.scene->metric.radius);
}

Proxy::Outcome Proxy::step(const Tick& tick) noexcept {
  const Motion wanted = motionTo(*tick.tracked.scene, tick.target);
  if (wanted.shift == glm::dvec3(0.0) && wanted.spin == glm::dvec3(0.0)) return Outcome::AtRest;
  return here_.distance > kFree * margin_ ? freeStep(tick, wanted) : constrainedStep(tick, wanted);
}

Proxy::Outcome Proxy::freeStep(const Tick& tick, const Motion& wanted) noexcept {
  const ServoScene& scene = *tick.tracked.scene;
  const double travel = wayTo(tick);
  const double free = std::min(here_.distance - margin_, wayLeft_);
  // To the target to the last bit: a free part pulls at nothing.
  if (travel <= free)
    return take(tick, tick.target, travel) == Verdict::Taken ? Outcome::AtRest : Outcome::Stuck;
  if (!(free > kAtRest * margin_)) return Outcome::Stuck;
  const double share = free / travel;
  const RigidTransform pose = moved(scene, {share * wanted.shift, share * wanted.spin});
  return take(tick, pose, free) == Verdict::Taken ? Outcome::Moved : Outcome::Stuck;
}

bool Proxy::fillRows(const Tick& tick, double reach) noexcept {
  const ServoScene& scene = *tick.tracked.scene;
  const glm::dvec3 centre = pose_.applyToPoint(scene.centreInPart);
  const glm::dquat principalFromWorld = glm::conjugate(pose_.rotation * scene.metric.partFromPrincipal);
  rows_.clear();
  for (std::size_t i = 0; i < here_.count; ++i) {
    const ContactPair& pair = around_[i].pair;
    if (pair.distance > reach) continue;
    const glm::dvec3 arm = pair.point - centre;
    const glm::dvec3 turn = principalFromWorld * glm::cross(arm, pair.direction) / scene.metric.gyration;
    const glm::dvec3& u = pair.direction;
    rowContact_[rows_.size()] = static_cast<std::uint32_t>(i);
    rowArm_[rows_.size()] = arm;
    if (!rows_.add({u.x, u.y, u.z, turn.x, turn.y, turn.z}, pair.distance)) return false;
  }
  return true;
}

StepSolution Proxy::solve(const Tick& tick, const StepGoal& goal) noexcept {
  if (!(tick.settings.friction > 0.0)) return program_.solve(rows_, goal);
  const MassMetric& metric = tick.tracked.scene->metric;
  const glm::dquat principalFromWorld = glm::conjugate(pose_.rotation * metric.partFromPrincipal);
  return frictionProgram_
      .solve(rows_, {.step = goal,
                     .coefficient = tick.settings.friction,
                     .arms = std::span<const glm::dvec3>(rowArm_).first(rows_.size()),
                     .principalFromStep = glm::mat3_cast(principalFromWorld)})
      .step;
}

StepGoal Proxy::goalOf(const Tick& tick, const Motion& wanted) const noexcept {
  const MassMetric& metric = tick.tracked.scene->metric;
  const glm::dquat principalFromWorld = glm::conjugate(pose_.rotation * metric.partFromPrincipal);
  const double held = std::min(here_.distance, margin_);
  // Where not all contacts are there, what the others would allow shows after the step.
  const double known = std::max(here_.completeTo - held, kLeastStep * held);
  const glm::dvec3 turn = metric.gyration * (principalFromWorld * wanted.spin);
  const double way = std::sqrt(glm::dot(wanted.shift, wanted.shift) + glm::dot(turn, turn));
  const double mostTurn = kTurnShare * contactTurn(kContactReach * margin_, metric.radius);
  StepGoal goal;
  goal.wanted = {wanted.shift.x, wanted.shift.y, wanted.shift.z, turn.x, turn.y, turn.z};
  goal.cost = {.margin = margin_,
               .weight = std::clamp(kMarginWeight * way / margin_, kMarginWeight, kMostMarginWeight),
               .floor = kHalf * held};
  goal.gyration = metric.gyration;
  goal.reach = std::min({kPlanned * here_.distance, known, wayLeft_});
  goal.radius = std::max(metric.radius, goal.reach / mostTurn);
  return goal;
}

Proxy::Outcome Proxy::constrainedStep(const Tick& tick, const Motion& wanted) noexcept {
  const double held = std::min(here_.distance, margin_);
  if (!(wayLeft_ > kAtRest * held)) return Outcome::Stuck;
  StepGoal goal = goalOf(tick, wanted);
  if (!fillRows(tick, margin_ + goal.reach)) return Outcome::Stuck;
  account_.constraintCount = static_cast<std::uint32_t>(rows_.size());
  const Outcome outcome = programStep(tick, goal);
  if (outcome != Outcome::AtRest || !(held < kPinched * margin_)) return outcome;
  // Pinched, with no way back to the margin that is worth while: the clearance that there is will do, but
  // not less.
  goal.cost.margin = goal.cost.floor = held;
  return programStep(tick, goal);
}

Proxy::Outcome Proxy::programStep(const Tick& tick, const StepGoal& goal) noexcept {
  const MassMetric& metric = tick.tracked.scene->metric;
  const double held = std::min(here_.distance, margin_);
  const StepSolution solution = solve(tick, goal);
  keepContacts(solution);
  if (solution.activeCount == 0 && solution.scale == 1.0 && solution.share == 1.0)
    return take(tick, tick.target, wayTo(tick)) == Verdict::Taken ? Outcome::AtRest : Outcome::Stuck;
  const glm::dquat worldFromPrincipal = glm::normalize(pose_.rotation * metric.partFromPrincipal);
  const Motion motion{
      {solution.y[0], solution.y[1], solution.y[2]},
      worldFromPrincipal * (glm::dvec3(solution.y[3], solution.y[4], solution.y[5]) / metric.gyration)};
  const double travel = travelOf(glm::length(motion.shift), glm::length(motion.spin), metric.radius);
  if (!(travel > (account_.subSteps == 0 ? kAtRestAtFirst : kAtRest) * held)) return Outcome::AtRest;
  if (account_.subSteps == 0) firstTravel_ = travel;
  if (account_.subSteps >= kWorthwhileSteps && travel < kWorthwhile * firstTravel_) return Outcome::Stuck;
  return takeShortened(tick, trialOf(goal, solution), motion, travel);
}

Proxy::Trial Proxy::trialOf(const StepGoal& goal, const StepSolution& solution) const noexcept {
  Trial trial{goal.wanted, solution.y, goal.cost, 0.0};
  double along = 0.0;
  for (std::size_t k = 0; k < trial.step.size(); ++k)
    along += trial.wanted[k] * trial.step[k];
  const double lack = std::max(0.0, goal.cost.margin - here_.distance);
  const double lackAfter = std::max(0.0, goal.cost.margin - solution.t);
  trial.slope = 2.0 * (goal.cost.weight * lack * (lackAfter - lack) - along);
  return trial;
}

Proxy::Outcome Proxy::takeShortened(const Tick& tick, Trial trial, Motion motion, double travel) noexcept {
  Verdict verdict = Verdict::NoGain;
  for (int shortenings = 0; shortenings <= kMaxShortenings; ++shortenings) {
    // What rubs is held back by more than the program's cost.
    Trial* judged = tick.settings.friction > 0.0 ? nullptr : &trial;
    verdict = take(tick, moved(*tick.tracked.scene, motion), travel, judged);
    if (verdict == Verdict::Taken) return Outcome::Moved;
    // What lists do not cover a shorter step may not leave.
    if (finder_.isWorkSpent()) break;
    if (verdict == Verdict::NotProved) ++account_.shortenedSteps;
    const double share = verdict == Verdict::NoGain ? trial.bestShare : kHalf;
    motion = {share * motion.shift, share * motion.spin};
    for (double& y : trial.step)
      y *= share;
    trial.slope *= share;
    travel *= share;
  }
  account_.isStarved = finder_.isWorkSpent() || verdict == Verdict::Unknown;
  if (account_.isStarved) return Outcome::Stuck;
  if (verdict == Verdict::NoGain) return Outcome::AtRest;
  ++account_.refusedSteps;
  return Outcome::Stuck;
}

bool Proxy::isGain(Trial& trial, double distance) const noexcept {
  double before = 0.0, after = 0.0;
  for (std::size_t k = 0; k < trial.step.size(); ++k) {
    const double rest = trial.wanted[k] - trial.step[k];
    before += trial.wanted[k] * trial.wanted[k];
    after += rest * rest;
  }
  const double lackHere = std::max(0.0, trial.cost.margin - here_.distance);
  const double lackThere = std::max(0.0, trial.cost.margin - distance);
  before += trial.cost.weight * lackHere * lackHere;
  after += trial.cost.weight * lackThere * lackThere;
  // Least of the parabola through both, with the slope that the program knows here.
  const double bend = after - before - trial.slope;
  const double best = bend > 0.0 ? -trial.slope / (2.0 * bend) : kHalf;
  trial.bestShare = std::clamp(best, kLeastShare, kHalf);
  return after < before;
}

void Proxy::keepContacts(const StepSolution& solution) noexcept {
  holdingCount_ = 0;
  for (const ActivePair& pair : solution.pairs())
    holding_[holdingCount_++] = {around_[rowContact_[pair.row]], pair.multiplier};
}

Surroundings Proxy::lookAround(const Tick& tick, const RigidTransform& pose,
                               std::span<BodyContact> out) noexcept {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const Surroundings around = finder_.find(tick.tracked, pose, kContactReach * margin_, wayTo(tick), out);
  queryTime_ += std::chrono::duration<double>(Clock::now() - begin).count();
  return around;
}

void Proxy::raiseFloor(const Tick& tick) noexcept {
  const double lengths = tick.tracked.scene->metric.radius + glm::length(pose_.translation);
  const double highest = kFloor * margin_;
  floor_ = std::min(std::max({floor_, kFloorOfFirst * here_.distance, kRounding * lengths}), highest);
}

Proxy::Verdict Proxy::take(const Tick& tick, const RigidTransform& pose, double travel,
                           Trial* trial) noexcept {
  if (finder_.isWorkSpent()) return Verdict::Unknown;
  Surroundings there = lookAround(tick, pose, next_);
  if (there.completeTo == 0.0) return Verdict::Unknown;
  // What was known here is known there but for the way.
  there.distance = std::max(there.distance, here_.distance - travel);
  const double held = std::min(here_.distance, margin_);
  const bool isProved = travel < kProved * here_.distance;
  const bool isAllowed = there.distance >= here_.distance || there.distance >= std::max(kHalf * held, floor_);
  if (!isProved || !isAllowed) return Verdict::NotProved;
  if (trial != nullptr && !isGain(*trial, there.distance)) return Verdict::NoGain;
  pose_ = pose;
  here_ = there;
  wayLeft_ -= travel;
  raiseFloor(tick);
  std::swap(around_, next_);
  ++account_.subSteps;
  return Verdict::Taken;
}

}  // namespace nearfit
