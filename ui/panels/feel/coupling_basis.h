#pragma once

#include <cstdint>
#include <optional>

#include "core/haptics/device_limits.h"
#include "core/haptics/spring_bound.h"
#include "core/haptics/virtual_coupling.h"

namespace nearfit::ui {

/// Inputs of the stability bound, and the settings in force.
struct CouplingBasis {
  DeviceLimits device;  ///< Limits of the device in hand, or of the usual one.
  MassMetric metric;    ///< Metric of the moving part.
  /// Nominal period, or the measured one while the servo runs [s].
  double period = 1e-3;
  /// Coupling in force; only while the servo runs in the proxy mode.
  std::optional<CouplingState> inForce;
  /// Number of springs that push; only while the servo runs in a spring mode.
  std::optional<std::uint32_t> springs;
  SpringShares shares;  ///< What the bound lets through of them.
};

}  // namespace nearfit::ui
