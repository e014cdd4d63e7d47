#pragma once

#include <QString>
#include <memory>
#include <vector>

#include "device/interface/haptic_device.h"
#include "ui/model/device_choice.h"

namespace nearfit::desktop {

/// Source of the devices that can be taken in hand. Call it on the window's thread only.
class DeviceSource {
 public:
  virtual ~DeviceSource() = default;
  /// True if list() may differ from the last one. Cheap.
  virtual bool hasChanged() = 0;
  /// Lists the devices, and problems of plug-ins as entries without an id. Throws Error.
  virtual QVector<ui::DeviceChoice> list() = 0;
  /// Returns the id of the device that `wanted` names (see chooseDevice). Throws Error.
  virtual QString find(const QString& wanted) = 0;
  /// Creates a device of the last list; opens nothing yet. Throws Error if it is gone or cannot be used.
  virtual std::unique_ptr<HapticDevice> make(const QString& id) = 0;
};

/// Returns the devices on USB and of plug-ins; without USB, those of plug-ins alone, which is no error.
std::unique_ptr<DeviceSource> makeDeviceSource();

}  // namespace nearfit::desktop
