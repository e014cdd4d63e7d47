#pragma once

#include <cmath>

namespace nearfit::test {

/// A hand on a device in one dimension, as mass and damper under forces that are held over each step: solved
/// exactly, so that whatever is gained or lost is the controller's doing. Mass and damping [kg], [N s/m], or
/// inertia and damping [kg m^2], [N m s/rad]; both > 0.
class SimulatedHand {
 public:
  SimulatedHand(double mass, double damping, double position, double velocity)
      : mass_(mass), damping_(damping), position_(position), velocity_(velocity) {}

  void step(double force, double time) {
    const double last = force / damping_, rate = damping_ / mass_;
    const double excess = velocity_ - last;
    position_ += last * time - excess * std::expm1(-rate * time) / rate;
    velocity_ = last + excess * std::exp(-rate * time);
  }

  double position() const { return position_; }
  double velocity() const { return velocity_; }
  double kineticEnergy() const { return 0.5 * mass_ * velocity_ * velocity_; }

 private:
  double mass_, damping_, position_, velocity_;
};

}  // namespace nearfit::test
