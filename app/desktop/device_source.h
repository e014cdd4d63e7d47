#pragma once

#include <QObject>
#include <QString>
#include <QTimer>
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

/// Tells the window which devices there are, as they come and go.
class DeviceWatcher : public QObject {
  Q_OBJECT

 public:
  /// @param source  Must outlive this.
  explicit DeviceWatcher(DeviceSource& source);

  /// Polls now, and from now on twice a second.
  void start();
  /// Lists the device in hand as usable although it is busy: it is ours. Empty: none.
  void setInHand(const QString& id);
  /// Tells that a device was closed and others can have it.
  void letGo(const QString& id);
  /// Lists the devices now.
  void poll();

 signals:
  /// Emitted when the list changed. If no device is plugged in, a notice says which can be used.
  void devicesChanged(const QVector<nearfit::ui::DeviceChoice>& devices);

 private:
  void publish();

  DeviceSource& source_;
  QTimer timer_;
  QVector<ui::DeviceChoice> listed_, shown_;
  QString inHand_;
};

}  // namespace nearfit::desktop
