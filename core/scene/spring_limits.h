#pragma once

namespace nearfit {

/// What a dialog, a scene file or a command line may set. Wide enough for watch parts and ship engines;
/// beyond them a number is a slip of the unit.
constexpr double kMinCutoff = 1e-7, kMaxCutoff = 1e3;       ///< [m]
constexpr double kMinStiffness = 0.0, kMaxStiffness = 1e6;  ///< [N/m]
/// The printed law's stiffness is divided by a length: at a cutoff c its force peaks at k c^2 / 4.
constexpr double kMaxPrintedStiffness = 1e12;           ///< [N/m^2]
constexpr double kMinDamping = 0.0, kMaxDamping = 1e4;  ///< [N s/m]

}  // namespace nearfit
