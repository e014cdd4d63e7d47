#pragma once

#include <array>
#include <filesystem>
#include <numbers>
#include <string>

#include <glm/vec3.hpp>

#include "core/haptics/device_limits.h"

namespace nearfit::polhem {

constexpr double degrees(double angle) noexcept {
  return angle * std::numbers::pi / 180.0;
}

/// A joint with its encoder.
struct Joint {
  int encoder = 0;              ///< Which of the report's six, 0 to 5.
  double countsPerTurn = 2000;  ///< Of the encoder's shaft, all four edges counted.
  double gearRatio = 1.0;       ///< Turns of that shaft for one of the joint: body's over capstan's diameter.
  bool isReversed = false;      ///< Its counts fall as the angle rises.
  double restAngle = 0.0;       ///< In the rest [rad].
  double lower = -degrees(120);  ///< Farther it cannot be [rad].
  double upper = degrees(120);
  bool operator==(const Joint&) const = default;
};

/// A joint with a motor, on the shaft of its encoder.
struct DrivenJoint {
  Joint joint;
  double torqueConstant = 0.0259;  ///< [N m/A]
  double maxCurrent = 2.0;         ///< [A]
  bool operator==(const DrivenJoint&) const = default;
};

/// What a device of this kind is like: each that is built differs a little. What stands here is the
/// WoodenHaptics of 2015 as its makers publish it (Forsslund, Yip, Sallnas 2015), which has no gimbal; its
/// ranges, mass and damping are estimates.
struct Calibration {
  std::string name = "WoodenHaptics 2015";
  double columnHeight = 0.080;           ///< Of the arms' joint above the base [m].
  double lowerArm = 0.205;               ///< [m]
  double upperArm = 0.245;               ///< [m]
  glm::dvec3 origin{0.220, 0.0, 0.080};  ///< Of the workspace, from the base [m].
  /// The base's turn; the lower arm's lean from upright; the upper arm's lift from hanging.
  std::array<DrivenJoint, 3> joints{
      DrivenJoint{{0, 2000, 16.0, false, 0.0, -degrees(100), degrees(100)}, 0.0259, 2.0},
      DrivenJoint{{1, 2000, 12.0, false, 0.0, -degrees(80), degrees(100)}, 0.0259, 2.0},
      DrivenJoint{{2, 2000, 12.0, false, degrees(90), -degrees(20), degrees(190)}, 0.0259, 2.0}};
  bool hasGimbal = false;
  /// Roll about the upper arm, pitch across it, roll about the pen; angles 0 where the pen goes on as the
  /// arm.
  std::array<Joint, 3> gimbal{Joint{3, 1024}, Joint{4, 1024}, Joint{5, 1024}};
  double maxForce = 5.0;            ///< [N]
  double damping = 0.5;             ///< Physical, at the handle [N s/m].
  double mass = 0.15;               ///< Of what moves, as felt at the handle [kg].
  double rotationalDamping = 1e-3;  ///< [N m s/rad]
  double inertia = 4.5e-5;          ///< [kg m^2]
  bool operator==(const Calibration&) const = default;
};

/// Reads a calibration file (resources/docs/devices.md). Throws FileError, with the path of the value that is
/// wrong, why, and what is right.
Calibration readCalibration(const std::filesystem::path& file);

DeviceLimits limitsOf(const Calibration& calibration) noexcept;

}  // namespace nearfit::polhem
