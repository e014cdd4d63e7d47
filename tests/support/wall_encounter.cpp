#include "tests/support/wall_encounter.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/haptics/passivity_controller.h"
#include "tests/support/simulated_hand.h"

namespace nearfit::test {
namespace {

DeviceLimits limitsFor(const WallTrial& trial) {
  DeviceLimits limits;
  limits.maxForce = limits.maxTorque = 1e3;
  (trial.along == Along::Force ? limits.damping : limits.rotationalDamping) = trial.damping;
  return limits;
}

/// The hand with its controller, one tick after the other.
class Encounter {
 public:
  explicit Encounter(const WallTrial& trial)
      : trial_(trial),
        limits_(limitsFor(trial)),
        hand_(trial.mass, trial.damping, trial.position, trial.velocity),
        positions_(static_cast<std::size_t>(trial.wall.delay) + 2, trial.position) {}

  void tick() {
    hand_.step(held_ + trial_.push, WallTrial::kPeriod);
    HandInterval interval;
    component(interval.held.force, interval.held.torque) = held_;
    component(interval.shift, interval.turn) = hand_.position() - positions_.back();
    interval.duration = WallTrial::kPeriod;
    const double depth = std::max(hand_.position(), 0.0);
    controller_.observe(interval, limits_, 0.5 * trial_.wall.stiffness * depth * depth);
    positions_.push_back(hand_.position());
    held_ = wallForce();
    Wrench extra = controller_.damping(limits_, WallTrial::kPeriod);
    paid_ = component(extra.force, extra.torque);
    if (trial_.isControlled) held_ += paid_;
  }

  double speed() const { return std::abs(hand_.velocity()); }
  double paid() const { return paid_; }
  const PassivityController& controller() const { return controller_; }

 private:
  double& component(glm::dvec3& linear, glm::dvec3& angular) const {
    return (trial_.along == Along::Force ? linear : angular).x;
  }

  double wallForce() const {
    const std::size_t seen = positions_.size() - 1 - static_cast<std::size_t>(trial_.wall.delay);
    const double x = positions_[seen], v = (x - positions_[seen - 1]) / WallTrial::kPeriod;
    return x > 0.0 ? -trial_.wall.stiffness * x - trial_.wall.damping * v : 0.0;
  }

  const WallTrial trial_;
  const DeviceLimits limits_;
  SimulatedHand hand_;
  PassivityController controller_;
  std::vector<double> positions_;
  double held_ = 0.0, paid_ = 0.0;
};

}  // namespace

WallOutcome meetWall(const WallTrial& trial) {
  Encounter encounter(trial);
  WallOutcome outcome;
  for (int tick = 0; tick < trial.ticks; ++tick) {
    encounter.tick();
    outcome.paidTicks += encounter.paid() != 0.0;
    outcome.largestDebt = std::max(outcome.largestDebt, encounter.controller().debt());
    if (tick < trial.ticks / 4) outcome.early = std::max(outcome.early, encounter.speed());
    if (tick >= trial.ticks * 3 / 4) outcome.late = std::max(outcome.late, encounter.speed());
  }
  return outcome;
}

WallTrial wallOf(double stiffness, int delay) {
  WallTrial trial;
  trial.wall = {stiffness, 0.0, delay};
  return trial;
}

WallTrial leaningOn(double stiffness, double mass) {
  WallTrial trial = wallOf(stiffness);
  trial.mass = mass;
  trial.position = trial.push / stiffness;
  trial.velocity = 1e-4;
  return trial;
}

}  // namespace nearfit::test
