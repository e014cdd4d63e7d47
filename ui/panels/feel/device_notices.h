#pragma once

#include <QWidget>

#include "ui/model/device_choice.h"

class QLabel;
class QPushButton;

namespace nearfit::ui {

/// Says what keeps devices from being used if the user can fix it, and offers the command that does; or says
/// that there is no device. Hidden if there is nothing to say.
class DeviceNotices : public QWidget {
  Q_OBJECT

 public:
  explicit DeviceNotices(QWidget* parent = nullptr);

  void showDevices(const QVector<DeviceChoice>& devices);

 private:
  QLabel *none_, *text_;
  QPushButton* copy_;
  QString command_;
};

}  // namespace nearfit::ui
