#include "core/haptics/passivity_controller.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/haptics/wrench_conditioner.h"

namespace nearfit {
namespace {

/// Smaller forces and torques have no meaningful direction [N], [N m].
constexpr double kNoForce = 1e-9;

/// Sum of magnitudes: finite unless a component is not, or the sum overflows.
double sumOf(const glm::dvec3& v) noexcept {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

bool isFinite(const HandInterval& i) noexcept {
  return std::isfinite(sumOf(i.held.force) + sumOf(i.held.torque) + sumOf(i.shift) + sumOf(i.turn) +
                       sumOf(i.weight) + sumOf(i.partShift) + i.duration);
}

void follow(glm::dvec3& axis, const glm::dvec3& vector) noexcept {
  const double length = glm::length(vector);
  if (length > kNoForce) axis = vector / length;
}

/// Damping of translation [N s/m] and rotation [N m s/rad].
struct Damping {
  double linear, angular;

  double power(const Twist& twist) const noexcept {
    return linear * glm::dot(twist.linear, twist.linear) + angular * glm::dot(twist.angular, twist.angular);
  }
};

/// Applies as much of the damping as pays the debt within a period, and reduces the debt by that.
Wrench pay(const Twist& twist, double period, const Damping& most, double& debt) noexcept {
  const double payable = period * most.power(twist);
  if (!(debt > 0.0) || !(payable > 0.0)) return {};
  const double share = std::min(1.0, debt / payable);
  debt -= share * payable;
  return {-share * most.linear * twist.linear, -share * most.angular * twist.angular};
}

}  // namespace

void PassivityController::observe(const HandInterval& interval, const DeviceLimits& limits,
                                  double stored) noexcept {
  if (!isFinite(interval)) return;
  const double given =
      glm::dot(interval.held.force, interval.shift) + glm::dot(interval.held.torque, interval.turn);
  double earned = glm::dot(interval.weight, interval.partShift);
  follow(forceAxis_, interval.held.force - interval.weight);
  follow(torqueAxis_, interval.held.torque);
  Twist velocity;
  if (interval.duration > 0.0) {
    velocity = {interval.shift / interval.duration, interval.turn / interval.duration};
    const double share = 1.0 - (1.0 - kDoubtfulShare) * doubt_;
    earned += share * interval.duration * Damping{limits.damping, limits.rotationalDamping}.power(velocity);
    doubt_ = std::max(0.0, doubt_ - interval.duration / kDoubtTime);
  }
  if (!std::isfinite(given) || !std::isfinite(earned)) return;
  velocity_ = velocity;
  energyToHand_ += given;
  const double most = (doubt_ > 0.0 ? 0.0 : kSlack) + (stored > 0.0 ? stored : 0.0);
  balance_ = std::clamp(balance_ + (earned - given), -kMaxDebt, most);
  if (balance_ < 0.0) doubt_ = 1.0;
}

Wrench PassivityController::damping(const DeviceLimits& limits, double period) const noexcept {
  double debt = this->debt();
  if (!(debt > 0.0) || !(period > 0.0) || !std::isfinite(period)) return {};
  const Damping most{0.5 * limits.leastMass / period, 0.5 * limits.leastInertia / period};
  const Twist along{forceAxis_ * glm::dot(forceAxis_, velocity_.linear),
                    torqueAxis_ * glm::dot(torqueAxis_, velocity_.angular)};
  const Twist across{velocity_.linear - along.linear, velocity_.angular - along.angular};
  const Wrench first = pay(along, period, most, debt);
  const Wrench second = pay(across, period, most, debt);
  return limitWrench({first.force + second.force, first.torque + second.torque}, limits).wrench;
}

}  // namespace nearfit
