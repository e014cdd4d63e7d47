#pragma once

#include <array>
#include <filesystem>
#include <numbers>
#include <string>

#include <glm/vec3.hpp>

#include "core/haptics/device_limits.h"

namespace nearfit::polhem {

/// Converts degrees to radians.
constexpr double degrees(double angle) noexcept {
  return angle * std::numbers::pi / 180.0;
}

/// A joint and its encoder.
struct Joint {
  int encoder = 0;               ///< Index among the report's six encoders, 0 to 5.
  double countsPerTurn = 2000;   ///< Per turn of the encoder's shaft, all four edges counted.
  double gearRatio = 1.0;        ///< Shaft turns per joint turn: body's diameter over capstan's.
  bool isReversed = false;       ///< Counts fall as the angle rises.
  double restAngle = 0.0;        ///< Angle in the rest pose [rad].
  double lower = -degrees(120);  ///< Range that the joint cannot leave [rad].
  double upper = degrees(120);
  bool operator==(const Joint&) const = default;
};

/// A joint with a motor on its encoder's shaft.
struct DrivenJoint {
  Joint joint;
  double torqueConstant = 0.0259;  ///< [N m/A]
  double maxCurrent = 2.0;         ///< [A]
  bool operator==(const DrivenJoint&) const = default;
};

/// Properties of one device; each that is built differs a little. The defaults are the WoodenHaptics of
/// 2015 as its makers publish it (Forsslund, Yip, Sallnas 2015), without a gimbal; its ranges, mass and
/// damping are estimates.
struct Calibration {
  std::string name = "WoodenHaptics 2015";
  double columnHeight = 0.080;           ///< Height of the arms' joint above the base [m].
  double lowerArm = 0.205;               ///< Joint to joint [m].
  double upperArm = 0.245;               ///< Joint to the middle of handle or gimbal [m].
  glm::dvec3 origin{0.220, 0.0, 0.080};  ///< Origin of the workspace, from the base [m].
  /// Turn of the base; lean of the lower arm from upright; lift of the upper arm from hanging.
  std::array<DrivenJoint, 3> joints{
      DrivenJoint{{0, 2000, 16.0, false, 0.0, -degrees(100), degrees(100)}, 0.0259, 2.0},
      DrivenJoint{{1, 2000, 12.0, false, 0.0, -degrees(80), degrees(100)}, 0.0259, 2.0},
      DrivenJoint{{2, 2000, 12.0, false, degrees(90), -degrees(20), degrees(190)}, 0.0259, 2.0}};
  bool hasGimbal = false;
  /// Roll about the upper arm, pitch across it, roll about the pen; all 0 when the pen continues the arm.
  std::array<Joint, 3> gimbal{Joint{3, 1024}, Joint{4, 1024}, Joint{5, 1024}};
  double maxForce = 5.0;            ///< [N]
  double damping = 0.5;             ///< Physical damping at the handle [N s/m].
  double mass = 0.15;               ///< Moving mass as felt at the handle [kg].
  double rotationalDamping = 1e-3;  ///< [N m s/rad]
  double inertia = 4.5e-5;          ///< [kg m^2]
  bool operator==(const Calibration&) const = default;
};

/// Reads a calibration file (resources/docs/devices.md). Throws FileError that says which value is wrong,
/// why, and what is allowed.
Calibration readCalibration(const std::filesystem::path& file);

/// Returns the limits of a device with this calibration; it renders no torque.
DeviceLimits limitsOf(const Calibration& calibration) noexcept;

}  // namespace nearfit::polhem
