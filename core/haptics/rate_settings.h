#pragma once

#include <array>

namespace nearfit {

/// Maps the deflection of a device that is pushed to speed. The defaults suit a hand that has
/// never set anything.
struct RateSettings {
  /// Deflection below which nothing moves, since springs do not return to zero; 0 to kMaxDeadZone.
  double deadZone = 0.06;
  /// Exponent of the curve from there to full deflection: fine near the middle; kMinExponent to kMaxExponent.
  double exponent = 2.0;
  /// Speed at full deflection [m/s], before the mapping's scale; 0 to kMaxFullSpeed.
  double fullSpeed = 0.15;
  /// Angular speed at full deflection [rad/s]; 0 to kMaxFullTurn.
  double fullTurn = 1.5;
  /// Motion along x, y, z, then about them.
  std::array<bool, 6> isEnabled{true, true, true, true, true, true};
  std::array<bool, 6> isInverted{};  ///< In the same order.
  bool operator==(const RateSettings&) const = default;
};

/// Limits of the settings. Higher speeds suggest a wrong unit.
constexpr double kMaxDeadZone = 0.9;
constexpr double kMinExponent = 1.0, kMaxExponent = 5.0;
constexpr double kMaxFullSpeed = 10.0;  ///< [m/s]
constexpr double kMaxFullTurn = 50.0;   ///< [rad/s]

/// Names of the axes in commands and files, in order.
constexpr std::array<const char*, 6> kRateAxes = {"x", "y", "z", "rx", "ry", "rz"};

/// Throws UsageError naming the first value out of range.
void checkRateSettings(const RateSettings& settings);

}  // namespace nearfit
