#pragma once

#include <QWidget>

#include "ui/device_choice.h"

class QLabel;
class QPushButton;

namespace nearfit::ui {

/// What keeps devices from being used, as far as the user can do something about it, and the command that
/// does; or that there is none. Hidden when there is nothing to say.
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
