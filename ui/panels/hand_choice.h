#pragma once

#include <QWidget>

#include "ui/device_choice.h"
#include "ui/servo_status.h"

class QComboBox;
class QLabel;
class QProgressBar;
class QPushButton;

namespace nearfit::ui {

class DeviceNotices;

/// Whose hand it is: the script's, the user's by numbers and keys, or a device's; of a device also what state
/// it is in, and whether its forces are let out.
class HandChoice : public QWidget {
  Q_OBJECT

 public:
  explicit HandChoice(QWidget* parent = nullptr);

  Hand hand() const;
  /// Of the device that is chosen; empty for other hands.
  QString device() const;
  /// A device of the list, or a recording ("replay:FILE"); does nothing for what is not there.
  void choose(const QString& device);
  /// The recorded hand is chosen, whether a recording is or not.
  bool isRecorded() const;
  /// The recorded hand is chosen, and none is recorded: there is no device yet.
  bool isRecordingMissing() const;
  /// Devices come and go; what is chosen stays chosen where it is still there, else the scripted hand is.
  void showDevices(const QVector<DeviceChoice>& devices);
  void showStatus(const ServoStatus& status);

 signals:
  void handChanged();
  void armRequested(bool isArmed);
  void calibrateRequested();
  void recordingWanted();
  void resetRequested();

 private:
  int rowOf(const QString& device) const;
  void showChosen();

  QComboBox* box_;
  QLabel* state_;
  QPushButton *arm_, *calibrate_, *reset_, *recording_;
  QProgressBar* opening_;
  DeviceNotices* notices_;
  ServoStatus status_;
};

}  // namespace nearfit::ui
