#include "tests/stress/held_hand.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/rotation_vector.h"

namespace nearfit::stress {
namespace {

/// The grip is continuous: this short is as good [s].
constexpr double kLongestStep = 2.5e-4;

glm::dvec3 limited(const glm::dvec3& v, double most) {
  const double length = glm::length(v);
  return length > most ? v * (most / length) : v;
}

}  // namespace

HeldHand::HeldHand(const HandBody& body, const glm::dvec3& centreInPart, const RigidTransform& start)
    : body_(body),
      centreInPart_(centreInPart),
      origin_(start.applyToPoint(centreInPart)),
      shift_{test::SimulatedHand(body.mass, body.damping, 0.0, 0.0),
             test::SimulatedHand(body.mass, body.damping, 0.0, 0.0),
             test::SimulatedHand(body.mass, body.damping, 0.0, 0.0)},
      rotation_(start.rotation) {}

glm::dvec3 HeldHand::centre() const {
  return origin_ + glm::dvec3(shift_[0].position(), shift_[1].position(), shift_[2].position());
}

glm::dvec3 HeldHand::velocity() const {
  return {shift_[0].velocity(), shift_[1].velocity(), shift_[2].velocity()};
}

RigidTransform HeldHand::pose() const {
  return {rotation_, centre() - rotation_ * centreInPart_};
}

void HeldHand::step(const RigidTransform& wanted, const Wrench& wrench, double period) {
  const int steps = std::max(1, static_cast<int>(std::ceil(period / kLongestStep)));
  const double time = period / steps;
  const glm::dvec3 target = wanted.applyToPoint(centreInPart_);
  for (int i = 0; i < steps; ++i) {
    const glm::dvec3 pull =
        limited(body_.grip * (target - centre()), body_.strength) - body_.gripDamping * velocity();
    for (glm::length_t axis = 0; axis < 3; ++axis)
      shift_[static_cast<std::size_t>(axis)].step(wrench.force[axis] + pull[axis], time);
    const glm::dvec3 turn = rotationVector(wanted.rotation * glm::conjugate(rotation_));
    const glm::dvec3 twist =
        wrench.torque + limited(body_.gripTurn * turn, body_.turnStrength) - body_.gripTurnDamping * spin_;
    // As SimulatedHand, for a ball: its axes do not matter.
    const glm::dvec3 last = twist / body_.rotDamping, excess = spin_ - last;
    const double rate = body_.rotDamping / body_.inertia;
    const glm::dvec3 turned = last * time - excess * (std::expm1(-rate * time) / rate);
    spin_ = last + excess * std::exp(-rate * time);
    rotation_ = glm::normalize(rotationOf(turned) * rotation_);
  }
}

}  // namespace nearfit::stress
