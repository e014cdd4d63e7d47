#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "device/polhem/polhem_calibration.h"

namespace nearfit::polhem {

/// Joint angles.
struct Angles {
  glm::dvec3 arm{0.0};     ///< Driven joints [rad].
  glm::dvec3 gimbal{0.0};  ///< [rad]
};

/// Kinematics of a WoodenHaptics arm: two links on a base that turns about z, each driven from the base, so
/// that either leans by itself. With driven angles a, b, c, links L, M and column height h:
///
///     x = cos a (L sin b + M sin c)    y = sin a (L sin b + M sin c)    z = h + L cos b - M cos c
///
/// from the base, less the workspace's origin. Real-time safe.
/// Source: the makers' published kinematics (Forsslund et al., WoodenHaptics); the inverse is ours.
class Kinematics {
 public:
  explicit Kinematics(const Calibration& calibration) noexcept : is_(calibration) {}

  /// Returns the joint angles for encoder counts.
  /// @param rest  Counts in the rest pose. The counters may have wrapped since.
  Angles anglesOf(const std::array<std::int16_t, 6>& counts,
                  const std::array<std::int16_t, 6>& rest) const noexcept;
  /// Returns the joint angles in the rest pose.
  Angles restAngles() const noexcept { return anglesOf({}, {}); }
  /// True if every driven joint is within its range.
  bool isInRange(const glm::dvec3& arm) const noexcept;

  /// Returns the position of the handle [m].
  glm::dvec3 positionOf(const glm::dvec3& arm) const noexcept;
  /// Returns the orientation of the pen, with x along it; identity without a gimbal.
  glm::dquat orientationOf(const Angles& angles) const noexcept;
  /// Returns the motion of the handle per radian of each joint [m/rad], one column per joint.
  glm::dmat3 jacobian(const glm::dvec3& arm) const noexcept;
  /// Returns the driven angles for a handle position, with the elbow up (0 < b + c < pi) and the arm in
  /// front of the column or over it. Returns std::nullopt beyond the arms' reach, and on the column's axis,
  /// where a is arbitrary.
  std::optional<glm::dvec3> armFor(const glm::dvec3& position) const noexcept;

  /// Returns the currents that make the handle push with `force` [mA], rounded towards zero: J^T f at the
  /// joints (virtual work, without friction and weight), divided by gear ratio and torque constant. If a
  /// motor would exceed its limit, all shrink alike to keep the direction.
  std::array<int, 3> milliampsFor(const glm::dvec3& force, const glm::dvec3& arm) const noexcept;

 private:
  Calibration is_;
};

}  // namespace nearfit::polhem
