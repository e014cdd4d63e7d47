#pragma once

#include <QObject>
#include <QTimer>

#include "app/desktop/device_source.h"

namespace nearfit::desktop {

/// Tells the window which devices there are, as they come and go.
class DeviceWatcher : public QObject {
  Q_OBJECT

 public:
  /// @param source  Outlives this.
  explicit DeviceWatcher(DeviceSource& source);

  /// Begins to look.
  void start();
  /// What is in hand is not busy: we have it. Empty for none.
  void setInHand(const QString& id);
  /// It has been closed, and others can have it.
  void letGo(const QString& id);
  /// Looks now.
  void look();

 signals:
  void devicesChanged(const QVector<nearfit::ui::DeviceChoice>& devices);

 private:
  void publish();

  DeviceSource& source_;
  QTimer timer_;
  QVector<ui::DeviceChoice> listed_, shown_;
  QString inHand_;
};

}  // namespace nearfit::desktop
