#pragma once

#include <cstdint>
#include <string>

#include "core/haptics/device_limits.h"
#include "core/haptics/handle_input.h"
#include "core/haptics/wrench.h"
#include "core/math/rigid_transform.h"

namespace nearfit {

enum class DeviceState : std::uint8_t { Absent, Ready, Running, Fault };

struct DeviceInfo {
  std::string name;
  int forceAxes = 0;  ///< 0, 3 or 6.
  DeviceLimits limits;
};

/// Something that a hand holds: gives the pose that the hand wants for the moving part, takes the wrench.
/// `start`, `stop` and `info` on the controlling thread; `readHandle` and `sendWrench` on the servo thread,
/// real-time safe. Every driver implements every call: there are no defaults to fall into.
class HapticDevice {
 public:
  virtual ~HapticDevice() = default;

  virtual DeviceInfo info() const = 0;
  virtual DeviceState state() const noexcept = 0;
  /// @param worldFromPart  Where the moving part is now: poses are given from there. Throws Error.
  virtual void start(const RigidTransform& worldFromPart) = 0;
  virtual void stop() noexcept = 0;

  /// The newest pose of the handle, from which the workspace mapping makes one in the world, and its age.
  /// False when the device has ended or been lost: `handle` is left as it was.
  virtual bool readHandle(HandleInput& handle) noexcept = 0;
  /// Takes a wrench that is finite and within the limits.
  virtual void sendWrench(const Wrench& wrench) noexcept = 0;
};

}  // namespace nearfit
