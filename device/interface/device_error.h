#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "core/base/error.h"

namespace nearfit {

/// Reasons why a device cannot be used.
enum class DeviceProblem : std::uint8_t {
  NoPermission,  ///< The user may not open it; a udev rule fixes that.
  Busy,          ///< Another program or driver holds it.
  Gone,          ///< Absent or unplugged.
  Unsupported,   ///< Differs from what its driver expects: other endpoints, a newer version.
  NoFirmware,    ///< Needs a file that its maker supplies.
  NoDriver,      ///< Needs its maker's driver, which is not installed or does not run.
  NotAnswering,  ///< Silent, or sends garbage.
  Failed,        ///< Anything else; the message says what.
};

/// Why a driver refuses one device of a kind that it supports; worded as an Error's problem and remedy.
struct DeviceRefusal {
  std::string reason, remedy;
};

/// Thrown if a device cannot be listed, opened, set up or calibrated.
class DeviceError : public Error {
 public:
  DeviceError(DeviceProblem cause, std::string where, std::string problem, std::string remedy = {})
      : Error(std::move(where), std::move(problem), std::move(remedy)), cause_(cause) {}

  DeviceProblem cause() const noexcept { return cause_; }

 private:
  DeviceProblem cause_;
};

}  // namespace nearfit
