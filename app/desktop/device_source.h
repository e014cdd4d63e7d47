#pragma once

#include <QString>
#include <memory>
#include <vector>

#include "device/haptic_device.h"
#include "ui/device_choice.h"

namespace nearfit::desktop {

/// Devices that are plugged in. All calls from the window's thread.
class DeviceSource {
 public:
  virtual ~DeviceSource() = default;
  /// Cheap: whether list() may give something else than the last time.
  virtual bool hasChanged() = 0;
  /// Throws Error.
  virtual QVector<ui::DeviceChoice> list() = 0;
  /// The id of the device that is meant (see chooseDevice). Throws Error.
  virtual QString find(const QString& wanted) = 0;
  /// One of the last list; nothing is opened yet. Throws Error: it is gone, or cannot be used.
  virtual std::unique_ptr<HapticDevice> make(const QString& id) = 0;
};

/// Those on USB and of plug-ins; none, and no error, where there is no USB.
std::unique_ptr<DeviceSource> makeDeviceSource();

}  // namespace nearfit::desktop
