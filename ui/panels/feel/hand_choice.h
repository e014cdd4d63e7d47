#pragma once

#include <QWidget>

#include "ui/model/device_choice.h"
#include "ui/model/servo_status.h"

class QComboBox;
class QLabel;
class QProgressBar;
class QPushButton;

namespace nearfit::ui {

class DeviceNotices;

/// Chooses the hand: the script's, the user's by numbers and keys, or a device's. Also shows a device's
/// state, and buttons to arm, calibrate and reset it.
class HandChoice : public QWidget {
  Q_OBJECT

 public:
  explicit HandChoice(QWidget* parent = nullptr);

  Hand hand() const;
  /// Returns the id of the chosen device; empty for other hands.
  QString device() const;
  /// Chooses a device of the list, or a recording ("replay:FILE"); no-op for anything else.
  void choose(const QString& device);
  /// True if the recorded hand is chosen, with or without a recording.
  bool isRecorded() const;
  /// True if the recorded hand is chosen without a recording: there is no device yet.
  bool isRecordingMissing() const;
  /// Lists the devices. Keeps the choice if it is still there, else chooses the scripted hand.
  void showDevices(const QVector<DeviceChoice>& devices);
  void showStatus(const ServoStatus& status);

 signals:
  /// Each is emitted when the user asks for what its name says; handChanged() when another hand was chosen.
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
