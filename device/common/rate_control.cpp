#include "device/common/rate_control.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace nearfit {
namespace {

/// Returns `velocity` with its component against `load` reduced, to zero as the load reaches `limit`.
glm::dvec3 leashed(const glm::dvec3& velocity, const glm::dvec3& load, double limit) noexcept {
  const double size = glm::length(load);
  if (!(size > 0.0) || !(limit > 0.0)) return velocity;
  const glm::dvec3 along = load / size;
  const double against = glm::dot(velocity, along);
  if (against >= 0.0) return velocity;
  return velocity - std::min(size / limit, 1.0) * against * along;
}

}  // namespace

double shapedDeflection(double deflection, const RateSettings& settings) noexcept {
  const double size = std::min(std::abs(deflection), 1.0);
  if (!(size > settings.deadZone)) return 0.0;
  const double beyond = (size - settings.deadZone) / (1.0 - settings.deadZone);
  return std::copysign(std::pow(beyond, settings.exponent), deflection);
}

const RigidTransform& RateControl::step(const std::array<double, 6>& axes, const RateSettings& settings,
                                        const Wrench& wrench, double time) noexcept {
  const auto shaped = [&](std::size_t axis) {
    if (!settings.isEnabled[axis]) return 0.0;
    return shapedDeflection(settings.isInverted[axis] ? -axes[axis] : axes[axis], settings);
  };
  const double seconds = std::clamp(time, 0.0, kLongestStep);
  const glm::dvec3 velocity =
      leashed(settings.fullSpeed * glm::dvec3(shaped(0), shaped(1), shaped(2)), wrench.force, leashForce_);
  const glm::dvec3 turning =
      leashed(settings.fullTurn * glm::dvec3(shaped(3), shaped(4), shaped(5)), wrench.torque, leashTorque_);
  pose_.translation += seconds * velocity;
  const double angle = seconds * glm::length(turning);
  if (angle > 0.0) {
    pose_.rotation = glm::normalize(glm::angleAxis(angle, glm::normalize(turning)) * pose_.rotation);
  }
  return pose_;
}

}  // namespace nearfit
