#pragma once

#include <QObject>
#include <QTimer>

#include "app/desktop/device_source.h"

namespace nearfit::desktop {

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
