#include "device/polhem/polhem_kinematics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "device/polhem/polhem_protocol.h"

namespace nearfit::polhem {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
/// Nearer to the column's axis, the base's direction is encoder noise [m].
constexpr double kOnAxis = 1e-6;

double angleOf(const Joint& joint, std::int16_t count, std::int16_t rest) noexcept {
  // The difference of two 16-bit counters is right however often they have wrapped.
  const auto moved =
      static_cast<std::int16_t>(static_cast<std::uint16_t>(count) - static_cast<std::uint16_t>(rest));
  const double turned = moved / joint.countsPerTurn / joint.gearRatio * kTurn;
  return joint.restAngle + (joint.isReversed ? -turned : turned);
}

glm::dquat about(int axis, double angle) noexcept {
  glm::dvec3 direction(0.0);
  direction[axis] = 1.0;
  return glm::angleAxis(angle, direction);
}

}  // namespace

Angles Kinematics::anglesOf(const std::array<std::int16_t, 6>& counts,
                            const std::array<std::int16_t, 6>& rest) const noexcept {
  const auto of = [&](const Joint& joint) {
    const auto encoder = static_cast<std::size_t>(joint.encoder);
    return angleOf(joint, counts[encoder], rest[encoder]);
  };
  Angles angles;
  for (int i = 0; i < 3; ++i) {
    const auto index = static_cast<std::size_t>(i);
    angles.arm[i] = of(is_.joints[index].joint);
    if (is_.hasGimbal) angles.gimbal[i] = of(is_.gimbal[index]);
  }
  return angles;
}

bool Kinematics::isInRange(const glm::dvec3& arm) const noexcept {
  for (int i = 0; i < 3; ++i) {
    const Joint& joint = is_.joints[static_cast<std::size_t>(i)].joint;
    if (!(arm[i] >= joint.lower && arm[i] <= joint.upper)) return false;
  }
  return true;
}

glm::dvec3 Kinematics::positionOf(const glm::dvec3& arm) const noexcept {
  const double out = is_.lowerArm * std::sin(arm.y) + is_.upperArm * std::sin(arm.z);
  const double up = is_.columnHeight + is_.lowerArm * std::cos(arm.y) - is_.upperArm * std::cos(arm.z);
  return glm::dvec3(out * std::cos(arm.x), out * std::sin(arm.x), up) - is_.origin;
}

glm::dquat Kinematics::orientationOf(const Angles& angles) const noexcept {
  if (!is_.hasGimbal) return {1.0, 0.0, 0.0, 0.0};
  // Upper arm, then roll, pitch and roll again.
  return about(2, angles.arm.x) * about(1, 0.5 * std::numbers::pi - angles.arm.z) *
         about(0, angles.gimbal.x) * about(1, angles.gimbal.y) * about(0, angles.gimbal.z);
}

glm::dmat3 Kinematics::jacobian(const glm::dvec3& arm) const noexcept {
  const double sinA = std::sin(arm.x), cosA = std::cos(arm.x);
  const double lowerSin = is_.lowerArm * std::sin(arm.y), lowerCos = is_.lowerArm * std::cos(arm.y);
  const double upperSin = is_.upperArm * std::sin(arm.z), upperCos = is_.upperArm * std::cos(arm.z);
  const double out = lowerSin + upperSin;
  return {glm::dvec3(-sinA * out, cosA * out, 0.0), glm::dvec3(cosA * lowerCos, sinA * lowerCos, -lowerSin),
          glm::dvec3(cosA * upperCos, sinA * upperCos, upperSin)};
}

std::optional<glm::dvec3> Kinematics::armFor(const glm::dvec3& position) const noexcept {
  const glm::dvec3 p = position + is_.origin;
  const double out = std::hypot(p.x, p.y), up = p.z - is_.columnHeight;
  const double reach = std::hypot(out, up);
  const double lower = is_.lowerArm, upper = is_.upperArm;
  if (!(out > kOnAxis) || reach > lower + upper || reach < std::abs(lower - upper)) return std::nullopt;
  // Angles from upright in the arms' plane; the law of cosines gives each link's lean from the aim.
  const double aim = std::atan2(out, up);
  const auto lean = [reach](double link, double other) {
    const double cosine = (reach * reach + link * link - other * other) / (2.0 * reach * link);
    return std::acos(std::clamp(cosine, -1.0, 1.0));
  };
  return glm::dvec3(std::atan2(p.y, p.x), aim - lean(lower, upper),
                    std::numbers::pi - (aim + lean(upper, lower)));
}

std::array<int, 3> Kinematics::milliampsFor(const glm::dvec3& force, const glm::dvec3& arm) const noexcept {
  const glm::dvec3 torque = glm::transpose(jacobian(arm)) * force;
  glm::dvec3 current(0.0);
  double scale = 1.0;
  for (int i = 0; i < 3; ++i) {
    const DrivenJoint& driven = is_.joints[static_cast<std::size_t>(i)];
    const double gear = driven.joint.isReversed ? -driven.joint.gearRatio : driven.joint.gearRatio;
    current[i] = torque[i] / gear / driven.torqueConstant;
    const double maxCurrent = std::min(driven.maxCurrent, 1e-3 * kMaxMilliamps);
    if (std::abs(current[i]) > maxCurrent) scale = std::min(scale, maxCurrent / std::abs(current[i]));
  }
  std::array<int, 3> milliamps{};
  for (int i = 0; i < 3; ++i) {
    const double value = 1e3 * scale * current[i];
    // A current that is not finite becomes zero.
    if (std::isfinite(value)) milliamps[static_cast<std::size_t>(i)] = static_cast<int>(value);
  }
  return milliamps;
}

}  // namespace nearfit::polhem
