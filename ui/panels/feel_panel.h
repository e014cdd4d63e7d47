#pragma once

#include <QWidget>

#include "core/haptics/servo_snapshot.h"
#include "ui/device_choice.h"
#include "ui/feel_mode.h"
#include "ui/servo_status.h"

class QComboBox;
class QLabel;
class QPushButton;
class QVBoxLayout;

namespace nearfit::ui {

class FeelNotice;
class HandChoice;

/// Start and stop of the servo, whose hand it is, the mode, and what is felt: wrench, minima, contact and
/// timing in numbers.
class FeelPanel : public QWidget {
  Q_OBJECT

 public:
  /// @param settingsButton  Opens the settings; becomes part of this panel.
  explicit FeelPanel(QWidget* settingsButton, QWidget* parent = nullptr);

  Hand hand() const;
  /// Of the device that is chosen as hand; else empty.
  QString device() const;
  /// The recorded hand is chosen, and no recording.
  bool isRecordingMissing() const;
  /// Does nothing where it is not in the list.
  void chooseDevice(const QString& device);
  void showDevices(const QVector<DeviceChoice>& devices);
  void setStartable(bool isStartable);
  void showStatus(const ServoStatus& status);
  void showMode(FeelMode mode);
  /// @param scene  For the names of the parts.
  void showSnapshot(const ServoSnapshot& snapshot, const Scene& scene);
  void clearSnapshot();

 signals:
  void startRequested();
  void stopRequested();
  void restartRequested();
  void handChanged();
  void armRequested(bool isArmed);
  void calibrateRequested();
  void recordingWanted();
  void resetRequested();
  void modeRequested(nearfit::ui::FeelMode mode);

 private:
  void setUpChoices(QVBoxLayout& layout, QWidget* settingsButton);
  void setUpReadouts(QVBoxLayout& layout);
  void showProxy(const ServoSnapshot& snapshot);
  QLabel* addReadout(QVBoxLayout& layout, const QString& name, const QString& objectName);
  void addHeading(QVBoxLayout& layout, const QString& text);

  HandChoice* hand_;
  QComboBox* mode_;
  QPushButton* startStop_;
  FeelNotice* notice_;
  QLabel *force_, *torque_, *distance_, *minima_, *contacts_, *lead_, *energy_, *clamped_;
  QLabel *rate_, *lateness_, *tick_, *subSteps_, *overruns_, *scheduling_;
  bool isTaken_ = false, isStartable_ = false;
};

}  // namespace nearfit::ui
