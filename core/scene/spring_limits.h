#pragma once

namespace nearfit {

/// What a dialog, a scene file or a command line may set. Wide enough for watch parts and ship engines; beyond
/// them a number is a slip of the unit.
constexpr double kMinCutoff = 1e-7, kMaxCutoff = 1e3;         ///< [m]
constexpr double kMinStiffness = 0.0, kMaxStiffness = 1e6;    ///< [N/m]
constexpr double kMinDamping = 0.0, kMaxDamping = 1e4;        ///< [N s/m]

}  // namespace nearfit
