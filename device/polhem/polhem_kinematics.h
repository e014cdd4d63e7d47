#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "device/polhem/polhem_calibration.h"

namespace nearfit::polhem {

struct Angles {
  glm::dvec3 arm{0.0};     ///< Of the driven joints [rad].
  glm::dvec3 gimbal{0.0};  ///< [rad]
};

/// The arm of a WoodenHaptics: two links on a base that turns about z, each driven from the base, so that
/// either leans by itself. With a, b, c the driven angles, L and M the links, h the column:
///
///     x = cos a (L sin b + M sin c)    y = sin a (L sin b + M sin c)    z = h + L cos b - M cos c
///
/// from the base; the workspace's origin is taken off. Real-time safe throughout.
/// Source: the makers' published kinematics (Forsslund et al., WoodenHaptics); the inverse is ours.
class Kinematics {
 public:
  explicit Kinematics(const Calibration& calibration) noexcept : is_(calibration) {}

  /// @param rest  What the encoders counted in the rest. The counts may have wrapped since.
  Angles anglesOf(const std::array<std::int16_t, 6>& counts,
                  const std::array<std::int16_t, 6>& rest) const noexcept;
  Angles restAngles() const noexcept { return anglesOf({}, {}); }
  /// Whether each driven joint is within its range.
  bool isInRange(const glm::dvec3& arm) const noexcept;

  /// Of the handle [m].
  glm::dvec3 positionOf(const glm::dvec3& arm) const noexcept;
  /// Of the pen. x runs along it. Identity without a gimbal.
  glm::dquat orientationOf(const Angles& angles) const noexcept;
  /// What the handle moves for each radian [m/rad]: a column a joint.
  glm::dmat3 jacobian(const glm::dvec3& arm) const noexcept;
  /// The angles that bring the handle there, with the elbow up (0 < b + c < pi) and the arm before the column
  /// or over it; nothing beyond the arms' reach, or on the column's axis, where a is any.
  std::optional<glm::dvec3> armFor(const glm::dvec3& position) const noexcept;

  /// The currents that make the handle push with `force` [mA]: J^T f on the joints (virtual work, friction
  /// and weight left out), over gears and torque constants. Where a motor cannot, all push less, so that the
  /// direction stays; rounded towards zero.
  std::array<int, 3> milliampsFor(const glm::dvec3& force, const glm::dvec3& arm) const noexcept;

 private:
  Calibration is_;
};

}  // namespace nearfit::polhem
