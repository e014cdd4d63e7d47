#include "app/cli/device_armer.h"

#include "app/cli/output.h"
#include "core/base/error.h"

namespace nearfit::cli {

std::string DeviceArmer::poll() {
  if (!isWanted_ || hasArmed_) return {};
  const DeviceState state = device_.state();
  if (state == DeviceState::Uncalibrated && !hasTold_) {
    printError("not armed yet: " + device_.stateNote());
    hasTold_ = true;
  }
  if (state != DeviceState::Ready) return {};
  try {
    device_.arm();
  } catch (const Error& e) {
    return e.problem();
  }
  hasArmed_ = true;
  return {};
}

}  // namespace nearfit::cli
