#pragma once

#include <array>

namespace nearfit {

/// How the deflection of a device that is pushed becomes speed. As it stands it suits a hand that has never
/// set anything.
struct RateSettings {
  double deadZone =
      0.06;               ///< Deflection below which nothing moves: springs do not come back to zero; [0, 1).
  double exponent = 2.0;  ///< Of the curve from there to full deflection: fine near the middle; [1, 5].
  double fullSpeed = 0.15;  ///< At full deflection [m/s], before the mapping's scale.
  double fullTurn = 1.5;    ///< [rad/s]
  std::array<bool, 6> isEnabled{true, true, true, true, true, true};  ///< Axes x, y, z, and about them.
  std::array<bool, 6> isInverted{};                                   ///< The same.
  bool operator==(const RateSettings&) const = default;
};

/// What may be set. Speeds beyond these are a slip of the unit.
constexpr double kMaxDeadZone = 0.9;
constexpr double kMinExponent = 1.0, kMaxExponent = 5.0;
constexpr double kMaxFullSpeed = 10.0;  ///< [m/s]
constexpr double kMaxFullTurn = 50.0;   ///< [rad/s]

/// Names of the axes, in order, as commands and files have them.
constexpr std::array<const char*, 6> kRateAxes = {"x", "y", "z", "rx", "ry", "rz"};

/// Throws UsageError that names what is out of range.
void checkRateSettings(const RateSettings& settings);

}  // namespace nearfit
