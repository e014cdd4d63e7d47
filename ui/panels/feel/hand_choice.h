#pragma once

#include <QWidget>

#include "ui/model/device_choice.h"
#include "ui/model/servo_status.h"
#include "ui/panels/feel/feel_page.h"

class QAction;
class QComboBox;
class QLabel;
class QProgressBar;
class QPushButton;
class QToolButton;

namespace nearfit::ui {

class LocksPage;

/// Says what keeps devices from being used, if the user can fix it, and offers the command that does. Without
/// devices it says that none is plugged in. Hidden otherwise.
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

/// Chooses the hand: the script's, the user's by numbers and keys, or a device's. Also shows a device's
/// state, and buttons to arm, calibrate and reset it.
///
/// Remembers between runs what the user chose, except a recording. At first it is a device that is plugged in,
/// else the manual hand; the manual hand also stands in for a device that is missing.
class HandChoice : public QWidget {
  Q_OBJECT

 public:
  explicit HandChoice(QWidget* parent = nullptr);

  Hand hand() const;
  /// Returns the id of the chosen device; empty for other hands.
  QString device() const;
  /// Chooses a device of the list, or a recording ("replay:FILE"); no-op for anything else.
  void choose(const QString& device);
  /// Chooses the scripted hand.
  void chooseScripted();
  /// True if the recorded hand is chosen, with or without a recording.
  bool isRecorded() const;
  /// True if the recorded hand is chosen without a recording: there is no device yet.
  bool isRecordingMissing() const;
  /// Lists the devices. Keeps the user's choice if it is still there, else chooses as at the start.
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
  /// Returns the row of the remembered hand, or of the one that stands in for it.
  int rowOfRemembered() const;
  void remember();
  void listDevices(const QVector<DeviceChoice>& devices);
  void showChosen();

  QComboBox* box_;
  QLabel* state_;
  QPushButton *arm_, *calibrate_, *reset_, *recording_;
  QProgressBar* opening_;
  DeviceNotices* notices_;
  ServoStatus status_;
  bool isChosen_ = false;  ///< In this run, by the user or by choose().
};

/// Settings of the hand's workspace, within reach while it feels: scale and clutch of a device, and which
/// motions count. A scripted hand has nothing to set.
class HandWorkspace : public FeelPage {
  Q_OBJECT

 public:
  /// @param clutch  Holds the part while it is on.
  explicit HandWorkspace(QAction* clutch, QWidget* parent = nullptr);

  /// Shows what this hand can set.
  /// @param isRecorded  True for a recording, which contains scale and locks already: a note says so.
  void showHand(Hand hand, bool isRecorded = false);
  /// Shows whether the part stays, by the clutch here or by the device's own.
  void showClutched(bool isClutched);
  /// Says that the part stays until the device is calibrated, whatever the clutch does.
  void showUncalibrated(bool isUncalibrated);

 protected:
  void refresh() override;

 private:
  QWidget* scaleRow_;
  QToolButton* clutch_;
  QLabel *note_, *recorded_;
  LocksPage* locks_;
};

}  // namespace nearfit::ui
