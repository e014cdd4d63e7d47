#include "core/servo/proxy.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
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
/// A step of no larger share is proved by its length.
constexpr double kShort = 0.99;
/// Max turn of a step, as a share of the turn that contacts are relaxed by: everything that the step can
/// bring nearer is then among them.
constexpr double kTurnShare = 1.0;
/// Nearer than this share of the margin a part is pinched: pressing alone does not bring it there.
constexpr double kPinched = 0.97;
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
/// Max length of a step whose way is proved pair by pair, in margins. Each step as long as it was planned allows
/// one twice as long; one that is not taken halves it.
constexpr double kMaxStride = 16.0;
constexpr double kStrideOfRoom = 0.9;
/// A step counts as long as planned from this share on: scales are found only so well (TrustSearch::kMinShare).
constexpr double kLongStride = 0.8;
/// After this many steps in a tick, a step shorter than this share of the first is left to the next tick.
constexpr std::uint32_t kWorthwhileSteps = 3;
constexpr double kWorthwhile = 0.05;
/// Weight of the margin for each margin of wanted motion: it holds the margin to a hundredth for each
/// direction pressed.
constexpr double kMarginWeight = 100.0, kMaxMarginWeight = 1e6;

/// A part this share of the margin off its joints is on them: what is left is taken back at once.
constexpr double kOnJoints = 1e-3;
/// Share of a step's reach that the way back to the joints may take: what is left is for where the hand leads.
constexpr double kReachToJoints = 0.5;

/// Changes of the active rows allowed for feltPose(): contact problems take some ten, and the hand waits.
constexpr unsigned kFeltChanges = 24;
/// Work of a program, in units of ContactFinder::work(): rows filled in that time, and for each change of the
/// active rows a fixed part and rows scanned.
constexpr std::uint64_t kRowsFilledOfWork = 2, kWorkOfChange = 6, kRowsScannedOfWork = 64;

double product(const StepVector& a, const StepVector& b) noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k)
    sum += a[k] * b[k];
  return sum;
}

std::uint64_t workOfChanges(std::uint64_t changes, std::size_t rows) noexcept {
  return changes * (kWorkOfChange + rows / kRowsScannedOfWork);
}

/// Work that a program is expected to take.
std::uint64_t workOfPlan(std::size_t rows) noexcept {
  constexpr std::uint64_t kUsualChanges = 16;
  return 1 + rows / kRowsFilledOfWork + (rows > 0 ? workOfChanges(kUsualChanges, rows) : 0);
}

}  // namespace

Proxy::Proxy() : around_(ContactFinder::kMaxContacts), next_(ContactFinder::kMaxContacts) {
  for (ContactRows* rows : {&rows_, &feltRows_}) {
    rows->contact.resize(ContactFinder::kMaxContacts);
    rows->arm.resize(ContactFinder::kMaxContacts);
    rows->direction.resize(ContactFinder::kMaxContacts);
  }
}

void Proxy::place(const RigidTransform& worldFromPart) noexcept {
  pose_ = felt_ = worldFromPart;
  lastTarget_.reset();
  rest_ = {};
  clearedSerial_ = 0;
  stride_ = 0.0;
  isHereKnown_ = isTrying_ = areFeltRowsFilled_ = false;
  stage_ = Stage::Done;
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
  isHereKnown_ = isTrying_ = false;
  judge_.dropFloor();
  rest_ = {};
  finder_.forget();
  return true;
}

void Proxy::begin(const TrackedScene& tracked, const RigidTransform& target, const ProxySettings& settings,
                  double turnScale) noexcept {
  account_ = {};
  queryTime_ = 0.0;
  finder_.beginTick();
  stage_ = Stage::Done;
  target_ = target;
  settings_ = settings;
  if (!isCleared(tracked)) {
    account_.isWaiting = true;
    holdingCount_ = 0;
    here_ = {};
    isTrying_ = areFeltRowsFilled_ = false;
    // Its former target is unknown; the way to the joints is not motion of the hand.
    lastTarget_ = tracked.scene->joints.isEmpty() ? std::optional(target) : std::nullopt;
    felt_ = pose_;
    return;
  }
  const ServoScene& scene = *tracked.scene;
  // The stiffnesses vary with the measured period; their rounding must not wake a part at rest.
  if (!(std::abs(turnScale - turnScale_) <= kSameScale * turnScale_)) {
    turnScale_ = turnScale;
    areFeltRowsFilled_ = false;
  }
  metric_ = scene.metric;
  metric_.gyration *= turnScale_;
  if (!scene.joints.isEmpty()) target_ = scene.joints.nearestPose(target, scene.centreInPart, metric_);
  if (isResting(tick(tracked))) return;
  rest_.isAtRest = false;
  const double targetTravel = lastTarget_ ? travelBetween(scene, *lastTarget_, target_) : 0.0;
  lastTarget_ = target_;
  // Where it was felt the pose may go at once.
  wayLeft_ = travelBetween(scene, pose_, felt_) + targetTravel +
             std::max(kSnapShare * travelBetween(scene, felt_, target_), settings.margin);
  // If the work ran out before, the lists may be ready now.
  if (!isHereKnown_ || margin_ != settings.margin || here_.completeTo == 0.0) {
    margin_ = settings.margin;
    isTrying_ = isHereKnown_ = areFeltRowsFilled_ = false;
    holdingCount_ = 0;
    stage_ = Stage::LookAround;
  } else if (isTrying_) {
    stage_ = Stage::Try;
    isForEarlier_ = isForEarlier_ || targetTravel > 0.0;
  } else {
    holdingCount_ = 0;
    stage_ = Stage::Plan;
  }
}

void Proxy::follow(const TrackedScene& tracked, const RigidTransform& target, const ProxySettings& settings,
                   double turnScale) noexcept {
  begin(tracked, target, settings, turnScale);
  advance(tracked, ContactFinder::kUsualWork, ContactFinder::Excess::ToGather);
}

bool Proxy::advance(const TrackedScene& tracked, std::uint64_t work, ContactFinder::Excess excess) noexcept {
  finder_.allow(work, excess);
  const Tick now = tick(tracked);
  while (stage_ != Stage::Done && goOn(now)) {
  }
  account_.isBehind = account_.isBehind || stage_ != Stage::Done;
  return stage_ == Stage::Done;
}

void Proxy::feel(const TrackedScene& tracked) noexcept {
  const bool isBehind = stage_ != Stage::Done || account_.isBehind;
  felt_ = isBehind && isHereKnown_ ? leadPose(tick(tracked)) : pose_;
}

void Proxy::end(Outcome outcome) noexcept {
  stage_ = Stage::Done;
  account_.isBehind = outcome == Outcome::Behind;
  rest_ = {target_, settings_, turnScale_, outcome == Outcome::AtRest};
}

bool Proxy::goOn(const Tick& tick) noexcept {
  if (stage_ == Stage::LookAround) {
    const Surroundings around = lookAround(tick, pose_, around_, nullptr);
    if (around.isPending) {
      account_.isStarved = finder_.lateBodies() > 0;
      return false;
    }
    here_ = around;
    isHereKnown_ = true;
    raiseFloor(tick);
    stage_ = Stage::Plan;
    if (here_.completeTo > 0.0) return true;
    account_.isStarved = true;
    end(Outcome::Behind);
    return true;
  }
  if (stage_ == Stage::Plan) {
    if (finder_.workLeft() < workOfPlan(here_.count)) return false;
    const Outcome outcome = account_.subSteps < kMaxSubSteps ? plan(tick) : Outcome::Behind;
    isTrying_ = outcome == Outcome::Moved;
    if (isTrying_)
      stage_ = Stage::Try;
    else
      end(outcome);
    return true;
  }
  const std::optional<Verdict> verdict = take(tick);
  if (!verdict) return false;
  Outcome outcome = settle(tick, *verdict);
  isTrying_ = outcome == Outcome::Moved && *verdict != Verdict::Taken;
  // A trial for an earlier target says nothing of the end of the way to this one.
  if (isForEarlier_ && (outcome == Outcome::AtRest || outcome == Outcome::Stuck)) outcome = Outcome::Moved;
  if (outcome != Outcome::Moved)
    end(outcome);
  else if (!isTrying_)
    stage_ = Stage::Plan;
  return true;
}

bool Proxy::isResting(const Tick& tick) const noexcept {
  return rest_.isAtRest && isHereKnown_ && here_.completeTo > 0.0 && tick.settings == rest_.settings &&
         turnScale_ == rest_.turnScale && tick.target == rest_.target;
}

/// The margin that is kept. It is smaller where so many pairs are near that a tick cannot look as far as it
/// should, as for a part that is pressed in: what holds the part must be within sight.
double Proxy::marginHere() const noexcept {
  return std::min(margin_, here_.reach / kSight);
}

Proxy::Outcome Proxy::plan(const Tick& tick) noexcept {
  const Motion wanted = motionBetween(*tick.tracked.scene, pose_, tick.target);
  if (wanted.shift == glm::dvec3(0.0) && wanted.spin == glm::dvec3(0.0)) return Outcome::AtRest;
  trial_ = {};
  isForEarlier_ = false;
  return here_.distance > kFree * marginHere() ? planFree(tick, wanted) : planConstrained(tick, wanted);
}

void Proxy::setTrial(const Tick& tick, const Motion& motion, double travel) noexcept {
  const ServoScene& scene = *tick.tracked.scene;
  trial_.isTarget = false;
  trial_.motion = motion;
  trial_.travel = travel;
  trial_.pose = moved(scene, motion);
  if (!isOnJoints(tick)) return;
  // The motion is on the joints to first order.
  const auto corrected = scene.joints.correctedPose(trial_.pose, scene.centreInPart, tick.metric);
  if (!corrected) return;
  trial_.pose = *corrected;
  trial_.travel = travelBetween(scene, pose_, trial_.pose);
}

void Proxy::setTrialToTarget(const Tick& tick, double travel) noexcept {
  trial_.isTarget = true;
  trial_.travel = travel;
  trial_.pose = tick.target;
}

Proxy::Outcome Proxy::planFree(const Tick& tick, const Motion& wanted) noexcept {
  const double travel = travelOf(*tick.tracked.scene, wanted);
  const double free = std::min(std::max(here_.distance - marginHere(), stride_), wayLeft_);
  trial_.isFree = true;
  trial_.goal.reach = free;
  trial_.motion = wanted;
  // To the target bit for bit: a free part exerts no force.
  if (travel <= free) {
    setTrialToTarget(tick, travel);
    return Outcome::Moved;
  }
  if (!(free > kAtRest * marginHere())) return Outcome::Stuck;
  const double share = free / travel;
  setTrial(tick, {share * wanted.shift, share * wanted.spin}, free);
  return Outcome::Moved;
}

Proxy::Outcome Proxy::settle(const Tick& tick, Verdict verdict) noexcept {
  if (verdict == Verdict::Taken) {
    const bool isLong = trial_.shortenings == 0 && trial_.travel > kLongStride * trial_.goal.reach;
    // The pairs gathered at a step's end must serve from its start.
    const double most = std::min(kMaxStride * margin_, kStrideOfRoom * finder_.room());
    if (isLong) stride_ = std::min(2.0 * trial_.travel, most);
    return trial_.isTarget ? Outcome::AtRest : Outcome::Moved;
  }
  stride_ = StepJudge::kHalf * trial_.travel;
  if (!trial_.isFree && !trial_.isTarget) return settleProgram(tick, verdict);
  if (!trial_.isFree && verdict != Verdict::Unknown) return Outcome::Stuck;
  if (trial_.shortenings == kMaxShortenings)
    return verdict == Verdict::Unknown ? Outcome::Behind : Outcome::Stuck;
  shorten(tick, StepJudge::kHalf);
  return Outcome::Moved;
}

bool Proxy::isOnJoints(const Tick& tick) const noexcept {
  const ServoScene& scene = *tick.tracked.scene;
  if (scene.joints.isEmpty()) return false;
  const LockedMotions locked = scene.joints.lockedMotions(pose_, scene.centreInPart, tick.metric);
  return travelOf(scene, motionOf(tick, {.y = locked.correction()})) <= kOnJoints * margin_;
}

bool Proxy::isTargetInReach(const Tick& tick, const Hold& hold, double reach) const noexcept {
  if (tick.tracked.scene->joints.isEmpty()) return true;
  return hold.isWhole && wayTo(tick) <= reach;
}

Proxy::Hold Proxy::holdFor(const Tick& tick, const StepGoal& goal, double reach) const noexcept {
  const ServoScene& scene = *tick.tracked.scene;
  Hold hold;
  if (scene.joints.isEmpty()) return hold;
  hold.locked = scene.joints.lockedMotions(pose_, scene.centreInPart, tick.metric);
  hold.back = hold.locked.correction();
  const double travel = displacementOf(hold.back, goal);
  if (travel <= kOnJoints * margin_) return hold;
  double share = std::min(1.0, kReachToJoints * goal.reach / travel);
  // No pair comes nearer by it than the nearest one is: contact holds against a joint.
  const double kept = std::min(here_.distance, marginHere());
  const glm::dvec3 centre = pose_.applyToPoint(scene.centreInPart);
  const glm::dquat principalFromWorld = scene.metric.principalFromWorld(pose_);
  for (std::size_t i = 0; i < here_.count; ++i) {
    const ContactPair& pair = around_[i].pair;
    if (pair.distance > reach) continue;
    const StepVector a = stepRow(pair.direction, pair.point - centre, principalFromWorld, tick.metric);
    const double nearer = -product(a, hold.back), room = std::max(0.0, pair.distance - kept);
    if (share * nearer > room) share = room / nearer;
  }
  hold.isWhole = share == 1.0;
  for (double& value : hold.back)
    value *= share;
  return hold;
}

bool Proxy::fillRows(const Tick& tick, double reach, ContactRows& out) noexcept {
  return out.hold.locked.isEmpty() ? fillRowsOf<false>(tick, reach, out) : fillRowsOf<true>(tick, reach, out);
}

template <bool kIsHeld>
bool Proxy::fillRowsOf(const Tick& tick, double reach, ContactRows& out) noexcept {
  const ServoScene& scene = *tick.tracked.scene;
  const glm::dvec3 centre = pose_.applyToPoint(scene.centreInPart);
  const glm::dquat principalFromWorld = scene.metric.principalFromWorld(pose_);
  out.rows.clear();
  for (std::size_t i = 0; i < here_.count; ++i) {
    const ContactPair& pair = around_[i].pair;
    if (pair.distance > reach) continue;
    const glm::dvec3 arm = pair.point - centre;
    out.contact[out.rows.size()] = static_cast<std::uint32_t>(i);
    out.arm[out.rows.size()] = arm;
    StepVector a = stepRow(pair.direction, arm, principalFromWorld, tick.metric);
    double distance = pair.distance;
    if constexpr (kIsHeld) {
      // The program finds the rest of the step, beside the way back.
      distance += product(a, out.hold.back);
      a = out.hold.locked.freePart(a);
      out.direction[out.rows.size()] = pair.direction;
    }
    if (!out.rows.add(a, distance)) return false;
  }
  return true;
}

StepSolution Proxy::solve(const Tick& tick, const ContactRows& rows, const StepGoal& goal,
                          unsigned mostChanges) noexcept {
  if (rows.hold.locked.isEmpty()) return solveFree(tick, rows, goal, mostChanges);
  StepGoal rest = goal;
  for (std::size_t k = 0; k < rest.wanted.size(); ++k)
    rest.wanted[k] -= rows.hold.back[k];
  rest.wanted = rows.hold.locked.freePart(rest.wanted);
  rest.reach = std::max(0.0, goal.reach - displacementOf(rows.hold.back, goal));
  StepSolution solution = solveFree(tick, rows, rest, mostChanges);
  for (std::size_t k = 0; k < solution.y.size(); ++k)
    solution.y[k] += rows.hold.back[k];
  solution.displacement = displacementOf(solution.y, goal);
  return solution;
}

StepSolution Proxy::solveFree(const Tick& tick, const ContactRows& rows, const StepGoal& goal,
                              unsigned mostChanges) noexcept {
  if (!(tick.settings.friction > 0.0)) return program_.solve(rows.rows, goal, mostChanges);
  const glm::dquat principalFromWorld = tick.tracked.scene->metric.principalFromWorld(pose_);
  return frictionProgram_
      .solve(rows.rows, {.step = goal,
                         .coefficient = tick.settings.friction,
                         .arms = std::span<const glm::dvec3>(rows.arm).first(rows.rows.size()),
                         .principalFromStep = glm::mat3_cast(principalFromWorld),
                         .locked = rows.hold.locked.directions(),
                         .directions = std::span<const glm::dvec3>(rows.direction)
                                           .first(rows.hold.locked.isEmpty() ? 0 : rows.rows.size())})
      .step;
}

Proxy::Motion Proxy::motionOf(const Tick& tick, const StepSolution& solution) const noexcept {
  const glm::dquat worldFromPrincipal = glm::normalize(tick.metric.worldFromPrincipal(pose_));
  const StepVector& y = solution.y;
  return {{y[0], y[1], y[2]}, worldFromPrincipal * (glm::dvec3(y[3], y[4], y[5]) / tick.metric.gyration)};
}

StepGoal Proxy::goalOf(const Tick& tick, const Motion& wanted) const noexcept {
  const MassMetric& metric = tick.metric;
  const double margin = marginHere(), held = std::min(here_.distance, margin);
  const glm::dvec3 spin = metric.principalFromWorld(pose_) * wanted.spin;
  const glm::dvec3 turn = metric.gyration * steepestTurn(spin, metric.gyration);
  const double way = std::sqrt(glm::dot(wanted.shift, wanted.shift) + glm::dot(turn, turn));
  const double mostTurn = kTurnShare * contactTurn(kContactReach * margin_, metric.radius);
  StepGoal goal;
  goal.wanted = {wanted.shift.x, wanted.shift.y, wanted.shift.z, turn.x, turn.y, turn.z};
  goal.cost = {.margin = margin,
               .weight = std::clamp(kMarginWeight * way / margin, kMarginWeight, kMaxMarginWeight),
               .floor = StepJudge::kHalf * held};
  goal.gyration = metric.gyration;
  const double proved = kPlanned * std::max(0.0, here_.distance - here_.deviation);
  goal.reach = std::min(std::max(proved, stride_), wayLeft_);
  // The lists hold for no larger turn: a part small enough to turn farther within the reach counts as larger.
  // The whole goal is shortened alike, so translation waits for rotation; a separate limit on the turn would
  // make such steps twice as long at most.
  goal.radius = std::max(metric.radius, goal.reach / mostTurn);
  return goal;
}

RigidTransform Proxy::leadPose(const Tick& tick) noexcept {
  const ServoScene& scene = *tick.tracked.scene;
  const Motion wanted = motionBetween(scene, pose_, tick.target);
  if (!(travelOf(scene, wanted) > 0.0) || !(here_.completeTo > 0.0) || !(wayLeft_ > 0.0)) return pose_;
  StepGoal goal = goalOf(tick, wanted);
  // One program: a search for the scale at which the step fits a reach would solve several.
  goal.reach = std::numeric_limits<double>::infinity();
  goal.radius = tick.metric.radius;
  feltRows_.hold = holdFor(tick, goal, here_.completeTo);
  if (!areFeltRowsFilled_ && !fillRows(tick, here_.completeTo, feltRows_)) return pose_;
  // With joints, rows depend on how much of the way back is taken.
  areFeltRowsFilled_ = feltRows_.hold.locked.isEmpty();
  const StepSolution solution = solve(tick, feltRows_, goal, kFeltChanges);
  keepContacts(feltRows_, solution);
  const Motion motion = motionOf(tick, solution);
  const double travel = travelOf(scene, motion);
  if (solution.activeCount == 0 && travel <= wayLeft_ && isTargetInReach(tick, feltRows_.hold, wayLeft_))
    return tick.target;
  // What is left of the way limits the motion, not what is wanted: a part that is pressed hard against a wall keeps
  // up along it.
  const double share = travel > wayLeft_ ? wayLeft_ / travel : 1.0;
  const RigidTransform lead = moved(scene, {share * motion.shift, share * motion.spin});
  if (!isOnJoints(tick)) return lead;
  return scene.joints.correctedPose(lead, scene.centreInPart, tick.metric).value_or(lead);
}

Proxy::Outcome Proxy::planConstrained(const Tick& tick, const Motion& wanted) noexcept {
  const double held = std::min(here_.distance, marginHere());
  if (!(wayLeft_ > kAtRest * held)) return Outcome::Stuck;
  const StepGoal goal = goalOf(tick, wanted);
  rows_.hold = holdFor(tick, goal, marginHere() + goal.reach);
  if (!fillRows(tick, marginHere() + goal.reach, rows_)) return Outcome::Stuck;
  account_.constraintCount = static_cast<std::uint32_t>(rows_.rows.size());
  finder_.spend(rows_.rows.size() / kRowsFilledOfWork);
  const Outcome outcome = planProgram(tick, goal, false);
  return outcome == Outcome::AtRest ? planPinched(tick, goal) : outcome;
}

Proxy::Outcome Proxy::planPinched(const Tick& tick, const StepGoal& goal) noexcept {
  const double held = std::min(here_.distance, marginHere());
  if (!(held < kPinched * marginHere())) return Outcome::AtRest;
  // Pinched, and no worthwhile step leads back to the margin: accept the present clearance, but no less.
  StepGoal accepting = goal;
  accepting.cost.margin = accepting.cost.floor = held;
  return planProgram(tick, accepting, true);
}

Proxy::Outcome Proxy::planProgram(const Tick& tick, const StepGoal& goal, bool isPinched) noexcept {
  const double held = std::min(here_.distance, marginHere());
  const StepSolution solution = solve(tick, rows_, goal, StepProgram::kMaxChanges);
  finder_.spend(workOfChanges(solution.changes, rows_.rows.size()));
  keepContacts(rows_, solution);
  trial_.goal = goal;
  trial_.isPinched = isPinched;
  if (solution.activeCount == 0 && solution.scale == 1.0 && solution.share == 1.0 &&
      isTargetInReach(tick, rows_.hold, goal.reach)) {
    trial_.motion = motionBetween(*tick.tracked.scene, pose_, tick.target);
    setTrialToTarget(tick, wayTo(tick));
    return Outcome::Moved;
  }
  const Motion motion = motionOf(tick, solution);
  const double travel = travelOf(*tick.tracked.scene, motion);
  // If the tick's remaining travel makes the step so short, or no gain, the next tick goes on.
  const bool isCutShort = goal.reach >= wayLeft_ && (solution.scale < 1.0 || solution.share < 1.0);
  trial_.best = isCutShort ? Outcome::Stuck : Outcome::AtRest;
  if (!(travel > (account_.subSteps == 0 ? kAtRestAtFirst : kAtRest) * held)) return trial_.best;
  if (account_.subSteps == 0) firstTravel_ = travel;
  if (account_.subSteps >= kWorthwhileSteps && travel < kWorthwhile * firstTravel_) return Outcome::Stuck;
  setTrial(tick, motion, travel);
  trial_.shortenings = 0;
  trial_.judged.reset();
  // Friction holds the part back beyond the program's cost, which then says nothing about gain.
  if (!(tick.settings.friction > 0.0)) trial_.judged.emplace(goal, solution, here_.distance);
  return Outcome::Moved;
}

void Proxy::shorten(const Tick& tick, double share) noexcept {
  ++trial_.shortenings;
  // A shorter step may stay within what the lists cover; one that its length proves needs nothing else. Where
  // the way was not known, or at last, it is that.
  const double proved = kPlanned * std::max(0.0, here_.distance - here_.deviation);
  const bool isLast = trial_.shortenings == kMaxShortenings;
  if (trial_.travel > proved && (isLast || isWayUnknown_)) share = std::min(share, proved / trial_.travel);
  if (trial_.judged) trial_.judged->shorten(share);
  setTrial(tick, {share * trial_.motion.shift, share * trial_.motion.spin}, share * trial_.travel);
}

Proxy::Outcome Proxy::settleProgram(const Tick& tick, Verdict verdict) noexcept {
  if (verdict == Verdict::NotProved) ++account_.shortenedSteps;
  if (trial_.shortenings < kMaxShortenings) {
    shorten(tick,
            verdict == Verdict::NoGain && trial_.judged ? trial_.judged->bestShare() : StepJudge::kHalf);
    return Outcome::Moved;
  }
  if (verdict == Verdict::Unknown) return Outcome::Behind;
  if (verdict == Verdict::NoGain) {
    if (trial_.best != Outcome::AtRest || trial_.isPinched) return trial_.best;
    return planPinched(tick, StepGoal(trial_.goal));
  }
  ++account_.refusedSteps;
  return Outcome::Stuck;
}

void Proxy::keepContacts(const ContactRows& rows, const StepSolution& solution) noexcept {
  holdingCount_ = 0;
  for (const ActivePair& pair : solution.pairs())
    holding_[holdingCount_++] = {around_[rows.contact[pair.row]], pair.multiplier};
}

Surroundings Proxy::lookAround(const Tick& tick, const RigidTransform& pose, std::span<BodyContact> out,
                               const ContactFinder::Step* step) noexcept {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const Surroundings around =
      finder_.find(tick.tracked, pose, kContactReach * margin_, wayTo(tick), out, step);
  queryTime_ += std::chrono::duration<double>(Clock::now() - begin).count();
  return around;
}

void Proxy::raiseFloor(const Tick& tick) noexcept {
  judge_.raiseFloor(here_.distance, margin_,
                    tick.tracked.scene->metric.radius + glm::length(pose_.translation));
}

std::optional<Proxy::Verdict> Proxy::take(const Tick& tick) noexcept {
  // A shorter step is proved by its length.
  const bool isLong = !(trial_.travel < kShort * (here_.distance - here_.deviation));
  const ContactFinder::Step step{pose_, isLong};
  Surroundings there = lookAround(tick, trial_.pose, next_, &step);
  if (there.isPending) {
    account_.isStarved = finder_.lateBodies() > 0;
    return std::nullopt;
  }
  // Unless a look succeeds: the lists must be renewed around where the part stands.
  account_.isStarved = there.completeTo == 0.0;
  isWayUnknown_ = isLong && there.onWay == 0.0;
  if (account_.isStarved) return Verdict::Unknown;
  // The bound here, less the travel, holds there too. Far from the origin a pose is rounded by more than a
  // small step is long; without that term such steps would add up unnoticed.
  const MassMetric& metric = tick.tracked.scene->metric;
  const double rounding = kPointRounding * (metric.radius + 2.0 * glm::length(trial_.pose.translation));
  there.distance = std::max(there.distance, here_.distance - trial_.travel - rounding);
  // If the search reached less than the margin, the distance there is only a bound and cannot tell gain.
  const double margin = marginHere();
  StepTrial* judged = trial_.judged && !(there.reach < margin) ? &*trial_.judged : nullptr;
  const Verdict verdict = judge_.judge(
      {trial_.travel, here_.distance, there.distance, margin, here_.deviation, there.onWay}, judged);
  if (verdict != Verdict::Taken) return verdict;
  pose_ = trial_.pose;
  here_ = there;
  wayLeft_ -= trial_.travel;
  raiseFloor(tick);
  std::swap(around_, next_);
  areFeltRowsFilled_ = false;
  ++account_.subSteps;
  return Verdict::Taken;
}

}  // namespace nearfit
