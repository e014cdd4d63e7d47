#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "core/error.h"

namespace nearfit {

/// Why a device cannot be used.
enum class DeviceProblem : std::uint8_t {
  NoPermission,  ///< The user may not open it: a udev rule mends that.
  Busy,          ///< Another program or driver holds it.
  Gone,          ///< Not there, or unplugged.
  Unsupported,   ///< Not what its driver expects: other endpoints, a newer version.
  NoFirmware,    ///< It needs a file that its maker supplies.
  NotAnswering,  ///< Silent, or answers with garbage.
  Failed,        ///< Anything else; the text says what.
};

/// Why one device of a kind that has a driver cannot be used, as of an Error.
struct DeviceRefusal {
  std::string reason, remedy;
};

/// A device that cannot be listed, opened, set up or calibrated.
class DeviceError : public Error {
 public:
  DeviceError(DeviceProblem cause, std::string where, std::string problem, std::string remedy = {})
      : Error(std::move(where), std::move(problem), std::move(remedy)), cause_(cause) {}

  DeviceProblem cause() const noexcept { return cause_; }

 private:
  DeviceProblem cause_;
};

}  // namespace nearfit
