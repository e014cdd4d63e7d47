#pragma once

#include "core/haptics/haptic_settings.h"

namespace nearfit {

/// Limits on what a dialog, a scene file or a command line may set: wide enough for watch parts and ship
/// engines. A number beyond them is probably in the wrong unit.
constexpr double kMinCutoff = 1e-7, kMaxCutoff = 1e3;       ///< [m]
constexpr double kMinStiffness = 0.0, kMaxStiffness = 1e6;  ///< Of a spring or the coupling [N/m].
/// The printed law's stiffness is per length: at cutoff c its force peaks at k c^2 / 4.
constexpr double kMaxPrintedStiffness = 1e12;           ///< [N/m^2]
constexpr double kMinDamping = 0.0, kMaxDamping = 1e4;  ///< Of a spring or the coupling [N s/m].
constexpr double kMinRotationalStiffness = 0.0, kMaxRotationalStiffness = 1e6;  ///< [N m/rad]
constexpr double kMinRotationalDamping = 0.0, kMaxRotationalDamping = 1e4;      ///< [N m s/rad]
/// The margin must not exceed the cutoff either: contact holds at the margin, and no search goes
/// beyond the cutoff.
constexpr double kMinMargin = 1e-9, kMaxMargin = 1.0;  ///< [m]
constexpr double kMinFriction = 0.0, kMaxFriction = 2.0;
constexpr double kMinScale = 1e-3, kMaxScale = 1e3;
constexpr double kMaxGravity = 1e3;  ///< Length of the vector [m/s^2]: a hundred times the Earth's.

/// Default margin for a cutoff: 1 % of it, within the limits [m].
double defaultMargin(double cutoff) noexcept;

/// Returns the springs with another law. Converts the stiffness so that a spring's max force stays the same
/// (k c for the linear law, k c^2 / 4 for the printed one), within the limits.
SpringParameters withLaw(SpringParameters springs, SpringLaw law) noexcept;

/// Throws UsageError if a value is not finite or out of range, the margin exceeds the cutoff, or the
/// orientation's length differs from 1 by more than kQuaternionSlack. The error's `where` names the value as
/// in scene files: "springs.cutoff", "coupling.rotationalDamping".
void checkHaptics(const HapticSettings& settings);

}  // namespace nearfit
