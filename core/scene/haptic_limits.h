#pragma once

#include "core/haptics/haptic_settings.h"

namespace nearfit {

/// What a dialog, a scene file or a command line may set. Wide enough for watch parts and ship engines;
/// beyond them a number is a slip of the unit.
constexpr double kMinCutoff = 1e-7, kMaxCutoff = 1e3;       ///< [m]
constexpr double kMinStiffness = 0.0, kMaxStiffness = 1e6;  ///< Of a spring or the coupling [N/m].
/// The printed law's stiffness is divided by a length: at a cutoff c its force peaks at k c^2 / 4.
constexpr double kMaxPrintedStiffness = 1e12;           ///< [N/m^2]
constexpr double kMinDamping = 0.0, kMaxDamping = 1e4;  ///< Of a spring or the coupling [N s/m].
constexpr double kMinRotationalStiffness = 0.0, kMaxRotationalStiffness = 1e6;  ///< [N m/rad]
constexpr double kMinRotationalDamping = 0.0, kMaxRotationalDamping = 1e4;      ///< [N m s/rad]
/// Also never more than the cutoff: contact holds at the margin, and nothing is looked for beyond the cutoff.
constexpr double kMinMargin = 1e-9, kMaxMargin = 1.0;  ///< [m]
constexpr double kMinFriction = 0.0, kMaxFriction = 2.0;
constexpr double kMinScale = 1e-3, kMaxScale = 1e3;
constexpr double kMaxGravity = 1e3;  ///< Length [m/s^2]: a hundred times the earth's.

/// A margin that suits a cutoff where nobody has chosen one: 1 % of it, within the limits.
double defaultMargin(double cutoff) noexcept;

/// Springs of another law. The stiffness is converted so that the most a spring pushes stays what it was (k c
/// for the linear law, k c^2 / 4 as printed), within the limits.
SpringParameters withLaw(SpringParameters springs, SpringLaw law) noexcept;

/// Throws UsageError when a value is not finite or out of its limits, the margin is larger than the cutoff,
/// or the orientation's length is off 1 by more than kQuaternionSlack. `where` names the value as scene files
/// do: "springs.cutoff", "coupling.rotationalDamping".
void checkHaptics(const HapticSettings& settings);

}  // namespace nearfit
