#pragma once

#include <cstdint>
#include <optional>

#include "core/haptics/device_limits.h"
#include "core/haptics/virtual_coupling.h"

namespace nearfit::ui {

/// What the bound of stability hangs on, and what of the settings is in force.
struct CouplingBasis {
  DeviceLimits device;
  MassMetric metric;  ///< Of the moving part.
  /// Nominal, or while the servo runs as measured [s].
  double period = 1e-3;
  /// While the servo runs in the proxy mode.
  std::optional<CouplingState> inForce;
  /// Springs that push: while the servo runs in one of their modes.
  std::optional<std::uint32_t> springs;
};

}  // namespace nearfit::ui
