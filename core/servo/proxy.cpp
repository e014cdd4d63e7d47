#include "core/servo/proxy.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>

#include "core/haptics/virtual_coupling.h"
#include "core/math/rotation_vector.h"
#include "core/math/tolerances.h"

namespace nearfit {
namespace {

/// Sight that a margin needs, in margins: a tick that sees less far keeps a smaller margin.
constexpr double kSight = 1.5;
/// If the nearest body is farther than this many margins, no constraints are needed.
constexpr double kFree = 1.7;
/// Share of the distance that a step is planned to use.
constexpr double kPlanned = 0.95;
/// Max turn of a step, as a share of the turn that contacts are relaxed by: everything that the step can
/// bring nearer is then among them.
constexpr double kTurnShare = 0.5;
/// Nearer than this share of the margin a part is pinched: pressing alone does not bring it there.
constexpr double kPinched = 0.97;
/// A step may always use this share of the distance.
constexpr double kMinStep = 0.5;
/// Max shortenings of a step before it is given up. On an edge the program's step is many times too
/// long, since the margin rounds the edge far more narrowly than the hand is deep; a parabola estimates
/// the best length.
constexpr int kMaxShortenings = 3;
/// A part that comes free goes this share of the way to its target in a tick, besides the target's own
/// motion: it does not leap.
constexpr double kSnapShare = 0.3;
/// Smaller relative changes of the scale of turns are ignored.
constexpr double kSameScale = 1e-3;
/// Motion below this share of the margin (or of the clearance) counts as rest: 0.1 um of 0.1 mm. The first
/// step of a tick may be smaller, so that a slow hand does not drag.
constexpr double kAtRest = 1e-3, kAtRestAtFirst = 1e-6;
/// After this many steps in a tick, a step shorter than this share of the first is left to the next tick.
constexpr std::uint32_t kWorthwhileSteps = 3;
constexpr double kWorthwhile = 0.05;
/// Weight of the margin for each margin of wanted motion: it holds the margin to a hundredth for each
/// direction pressed.
constexpr double kMarginWeight = 100.0, kMaxMarginWeight = 1e6;

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

Proxy::Motion Proxy::motionBetween(const ServoScene& scene, const RigidTransform& from,
                                   const RigidTransform& to) noexcept {
  return {to.applyToPoint(scene.centreInPart) - from.applyToPoint(scene.centreInPart),
          turnBetween(from.rotation, to.rotation)};
}

double Proxy::travelOf(const ServoScene& scene, const Motion& motion) noexcept {
  return glm::length(motion.shift) + glm::length(motion.spin) * scene.metric.radius;
}

double Proxy::travelBetween(const ServoScene& scene, const RigidTransform& from,
                            const RigidTransform& to) noexcept {
  return travelOf(scene, motionBetween(scene, from, to));
}

double Proxy::wayTo(const Tick& tick) const noexcept {
  return travelBetween(*tick.tracked.scene, pose_, tick.target);
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
  if (!(travelBetween(*tracked.scene, pose_, clearance.worldFromPart) < clearance.distance)) return false;
  clearedSerial_ = clearance.serial;
  isHereKnown_ = false;
  judge_.dropFloor();
  rest_ = {};
  finder_.forget();
  return true;
}

void Proxy::follow(const TrackedScene& tracked, const RigidTransform& target, const ProxySettings& settings,
                   double turnScale) noexcept {
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
  // The stiffnesses vary with the measured period; their rounding must not wake a part at rest.
  if (!(std::abs(turnScale - turnScale_) <= kSameScale * turnScale_)) turnScale_ = turnScale;
  Tick tick{tracked, target, settings, tracked.scene->metric};
  tick.metric.gyration *= turnScale_;
  if (isResting(tick)) return;
  // If the work ran out before, the lists may be ready now.
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
  rest_ = {target, settings, turnScale_, outcome == Outcome::AtRest};
  lastTarget_ = target;
}

bool Proxy::isResting(const Tick& tick) const noexcept {
  return rest_.isAtRest && isHereKnown_ && here_.completeTo > 0.0 && tick.settings == rest_.settings &&
         turnScale_ == rest_.turnScale && tick.target.translation == rest_.target.translation &&
         tick.target.rotation == rest_.target.rotation;
}

double Proxy::targetMotion(const Tick& tick) const noexcept {
  return travelBetween(*tick.tracked.scene, lastTarget_.value_or(pose_), tick.target);
}

/// The margin that is kept. It is smaller where so many pairs are near that a tick cannot look as far as it
/// should, as for a part that is pressed in: what holds the part must be within sight.
double Proxy::marginHere() const noexcept {
  return std::min(margin_, here_.reach / kSight);
}

Proxy::Outcome Proxy::step(const Tick& tick) noexcept {
  const Motion wanted = motionBetween(*tick.tracked.scene, pose_, tick.target);
  if (wanted.shift == glm::dvec3(0.0) && wanted.spin == glm::dvec3(0.0)) return Outcome::AtRest;
  return here_.distance > kFree * marginHere() ? freeStep(tick, wanted) : constrainedStep(tick, wanted);
}

Proxy::Outcome Proxy::freeStep(const Tick& tick, const Motion& wanted) noexcept {
  const ServoScene& scene = *tick.tracked.scene;
  const double travel = travelOf(scene, wanted);
  const double free = std::min(here_.distance - marginHere(), wayLeft_);
  // To the target bit for bit: a free part exerts no force.
  if (travel <= free) {
    const Verdict verdict = take(tick, tick.target, travel);
    if (verdict == Verdict::Taken) return Outcome::AtRest;
    if (verdict != Verdict::Unknown) return Outcome::Stuck;
  }
  if (!(free > kAtRest * marginHere())) return Outcome::Stuck;
  double share = std::min(travel <= free ? StepJudge::kHalf : 1.0, free / travel);
  // A shorter step may stay within what the lists cover.
  for (int shortenings = 0; shortenings <= kMaxShortenings; ++shortenings) {
    const RigidTransform pose = moved(scene, {share * wanted.shift, share * wanted.spin});
    const Verdict verdict = take(tick, pose, share * travel);
    if (verdict == Verdict::Taken) return Outcome::Moved;
    if (verdict != Verdict::Unknown || finder_.isWorkSpent()) break;
    share *= StepJudge::kHalf;
  }
  return Outcome::Stuck;
}

bool Proxy::fillRows(const Tick& tick, double reach) noexcept {
  const ServoScene& scene = *tick.tracked.scene;
  const glm::dvec3 centre = pose_.applyToPoint(scene.centreInPart);
  const glm::dquat principalFromWorld = scene.metric.principalFromWorld(pose_);
  rows_.clear();
  for (std::size_t i = 0; i < here_.count; ++i) {
    const ContactPair& pair = around_[i].pair;
    if (pair.distance > reach) continue;
    const glm::dvec3 arm = pair.point - centre;
    rowContact_[rows_.size()] = static_cast<std::uint32_t>(i);
    rowArm_[rows_.size()] = arm;
    if (!rows_.add(stepRow(pair.direction, arm, principalFromWorld, tick.metric), pair.distance))
      return false;
  }
  return true;
}

StepSolution Proxy::solve(const Tick& tick, const StepGoal& goal) noexcept {
  if (!(tick.settings.friction > 0.0)) return program_.solve(rows_, goal);
  const glm::dquat principalFromWorld = tick.tracked.scene->metric.principalFromWorld(pose_);
  return frictionProgram_
      .solve(rows_, {.step = goal,
                     .coefficient = tick.settings.friction,
                     .arms = std::span<const glm::dvec3>(rowArm_).first(rows_.size()),
                     .principalFromStep = glm::mat3_cast(principalFromWorld)})
      .step;
}

StepGoal Proxy::goalOf(const Tick& tick, const Motion& wanted) const noexcept {
  const MassMetric& metric = tick.metric;
  const double margin = marginHere(), held = std::min(here_.distance, margin);
  // If contacts are missing, what they allow shows only after the step.
  const double known = std::max(here_.completeTo - held, kMinStep * held);
  const glm::dvec3 turn = metric.gyration * (metric.principalFromWorld(pose_) * wanted.spin);
  const double way = std::sqrt(glm::dot(wanted.shift, wanted.shift) + glm::dot(turn, turn));
  const double mostTurn = kTurnShare * contactTurn(kContactReach * margin_, metric.radius);
  StepGoal goal;
  goal.wanted = {wanted.shift.x, wanted.shift.y, wanted.shift.z, turn.x, turn.y, turn.z};
  goal.cost = {.margin = margin,
               .weight = std::clamp(kMarginWeight * way / margin, kMarginWeight, kMaxMarginWeight),
               .floor = StepJudge::kHalf * held};
  goal.gyration = metric.gyration;
  goal.reach = std::min({kPlanned * std::max(0.0, here_.distance - here_.deviation), known, wayLeft_});
  // The lists hold for no larger turn: a part small enough to turn farther within the reach counts as larger.
  // The whole goal is shortened alike, so translation waits for rotation; a separate limit on the turn would
  // make such steps twice as long at most.
  goal.radius = std::max(metric.radius, goal.reach / mostTurn);
  return goal;
}

Proxy::Outcome Proxy::constrainedStep(const Tick& tick, const Motion& wanted) noexcept {
  const double held = std::min(here_.distance, marginHere());
  if (!(wayLeft_ > kAtRest * held)) return Outcome::Stuck;
  StepGoal goal = goalOf(tick, wanted);
  if (!fillRows(tick, marginHere() + goal.reach)) return Outcome::Stuck;
  account_.constraintCount = static_cast<std::uint32_t>(rows_.size());
  const Outcome outcome = programStep(tick, goal);
  if (outcome != Outcome::AtRest || !(held < kPinched * marginHere())) return outcome;
  // Pinched, and no worthwhile step leads back to the margin: accept the present clearance, but no less.
  goal.cost.margin = goal.cost.floor = held;
  return programStep(tick, goal);
}

Proxy::Outcome Proxy::programStep(const Tick& tick, const StepGoal& goal) noexcept {
  const MassMetric& metric = tick.metric;
  const double held = std::min(here_.distance, marginHere());
  const StepSolution solution = solve(tick, goal);
  keepContacts(solution);
  if (solution.activeCount == 0 && solution.scale == 1.0 && solution.share == 1.0)
    return take(tick, tick.target, wayTo(tick)) == Verdict::Taken ? Outcome::AtRest : Outcome::Stuck;
  const glm::dquat worldFromPrincipal = glm::normalize(metric.worldFromPrincipal(pose_));
  const Motion motion{
      {solution.y[0], solution.y[1], solution.y[2]},
      worldFromPrincipal * (glm::dvec3(solution.y[3], solution.y[4], solution.y[5]) / metric.gyration)};
  const double travel = travelOf(*tick.tracked.scene, motion);
  // If the tick's remaining travel makes the step so short, or no gain, the next tick goes on.
  const bool isCutShort = goal.reach >= wayLeft_ && (solution.scale < 1.0 || solution.share < 1.0);
  const Outcome best = isCutShort ? Outcome::Stuck : Outcome::AtRest;
  if (!(travel > (account_.subSteps == 0 ? kAtRestAtFirst : kAtRest) * held)) return best;
  if (account_.subSteps == 0) firstTravel_ = travel;
  if (account_.subSteps >= kWorthwhileSteps && travel < kWorthwhile * firstTravel_) return Outcome::Stuck;
  const Outcome outcome = takeShortened(tick, StepTrial(goal, solution, here_.distance), motion, travel);
  return outcome == Outcome::AtRest ? best : outcome;
}

Proxy::Outcome Proxy::takeShortened(const Tick& tick, StepTrial trial, Motion motion,
                                    double travel) noexcept {
  Verdict verdict = Verdict::NoGain;
  for (int shortenings = 0; shortenings <= kMaxShortenings; ++shortenings) {
    // Friction holds the part back beyond the program's cost, which then says nothing about gain.
    StepTrial* judged = tick.settings.friction > 0.0 ? nullptr : &trial;
    verdict = take(tick, moved(*tick.tracked.scene, motion), travel, judged);
    if (verdict == Verdict::Taken) return Outcome::Moved;
    // A shorter step may stay within what the lists cover.
    if (finder_.isWorkSpent()) break;
    if (verdict == Verdict::NotProved) ++account_.shortenedSteps;
    const double share = verdict == Verdict::NoGain ? trial.bestShare() : StepJudge::kHalf;
    motion = {share * motion.shift, share * motion.spin};
    trial.shorten(share);
    travel *= share;
  }
  if (account_.isStarved) return Outcome::Stuck;
  if (verdict == Verdict::NoGain) return Outcome::AtRest;
  ++account_.refusedSteps;
  return Outcome::Stuck;
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
  judge_.raiseFloor(here_.distance, margin_,
                    tick.tracked.scene->metric.radius + glm::length(pose_.translation));
}

Proxy::Verdict Proxy::take(const Tick& tick, const RigidTransform& pose, double travel,
                           StepTrial* trial) noexcept {
  // Unless a look succeeds: the lists must be renewed around where the part stands.
  account_.isStarved = true;
  if (finder_.isWorkSpent()) return Verdict::Unknown;
  Surroundings there = lookAround(tick, pose, next_);
  if (there.completeTo == 0.0) return Verdict::Unknown;
  account_.isStarved = finder_.isWorkSpent();
  // The bound here, less the travel, holds there too. Far from the origin a pose is rounded by more than a
  // small step is long; without that term such steps would add up unnoticed.
  const MassMetric& metric = tick.tracked.scene->metric;
  const double rounding = kPointRounding * (metric.radius + 2.0 * glm::length(pose.translation));
  there.distance = std::max(there.distance, here_.distance - travel - rounding);
  // If the search reached less than the margin, the distance there is only a bound and cannot tell gain.
  const double margin = marginHere();
  const Verdict verdict = judge_.judge({travel, here_.distance, there.distance, margin, here_.deviation},
                                       there.reach < margin ? nullptr : trial);
  if (verdict != Verdict::Taken) return verdict;
  pose_ = pose;
  here_ = there;
  wayLeft_ -= travel;
  raiseFloor(tick);
  std::swap(around_, next_);
  ++account_.subSteps;
  return Verdict::Taken;
}

}  // namespace nearfit
