#pragma once

#include <QWidget>

#include "core/servo/servo_snapshot.h"
#include "ui/model/device_choice.h"
#include "ui/model/feel_mode.h"
#include "ui/model/servo_status.h"

class QAction;
class QComboBox;
class QLabel;
class QPushButton;
class QToolButton;
class QVBoxLayout;

namespace nearfit::ui {

class FeelNotice;
class HandChoice;
class HandWorkspace;
class PresetChoice;
class PresetStore;

/// Starts and stops the servo, chooses hand and mode, and shows what is felt: wrench, minima, contact and
/// timing in numbers.
class FeelPanel : public QWidget {
  Q_OBJECT

 public:
  /// Widgets and presets that other classes provide.
  struct Parts {
    QWidget* settingsButton;  ///< Opens the settings; this panel becomes its parent.
    QAction* clutch;
    PresetStore& presets;  ///< Must outlive this.
  };
  explicit FeelPanel(const Parts& parts, QWidget* parent = nullptr);

  Hand hand() const;
  /// Returns the id of the device chosen as hand; empty for other hands.
  QString device() const;
  /// True if the recorded hand is chosen, but no recording.
  bool isRecordingMissing() const;
  /// Chooses a device; no-op if it is not in the list.
  void chooseDevice(const QString& device);
  void chooseScriptedHand();
  void showDevices(const QVector<DeviceChoice>& devices);
  /// Says what keeps the servo from starting; empty: nothing does.
  /// @param isHandEmpty  True if no part is in hand: offers the action of setTakeInHand().
  void showReadiness(const QString& whyNot, bool isHandEmpty);
  /// Sets the action that takes the selected part in hand.
  void setTakeInHand(QAction& takeInHand);
  void showStatus(const ServoStatus& status);
  /// Shows the scene's settings.
  void showSettings(const HapticSettings& settings);
  /// @param scene  Holds the parts' names.
  void showSnapshot(const ServoSnapshot& snapshot, const Scene& scene);
  void clearSnapshot();
  /// Shows the numbers of the last snapshot in grey: nothing is felt any more.
  void keepSnapshot(const ServoSnapshot& snapshot);
  /// Shows the numbers of a row of a recording that is played, and says that they are not felt now; until
  /// clearSnapshot().
  void showRecorded(const ServoSnapshot& row);

 signals:
  /// Each is emitted when the user asks for what its name says.
  void startRequested();
  void stopRequested();
  void restartRequested();
  void handChanged();
  void armRequested(bool isArmed);
  void calibrateRequested();
  void recordingWanted();
  void resetRequested();
  void modeRequested(nearfit::ui::FeelMode mode);
  void settingsEdited(const nearfit::HapticSettings& settings);
  void presetChosen(const nearfit::HapticSettings& settings, const QString& name);

 private:
  class Readouts;

  QWidget* makeChoices(const Parts& parts);
  void setUpReadouts();
  void showDevice(const ServoStatus& status);
  void showHand();
  void updateStart();
  void showNumbers(const ServoSnapshot& snapshot);
  void showProxy(const ServoSnapshot& snapshot);
  /// Says what limits the wrench.
  QString limitText(const ServoSnapshot& snapshot) const;
  /// Removes what only holds while the part is felt.
  void clearNotices();
  /// Numbers that are felt now, or were felt last.
  void setFelt(bool isFelt);

  HandChoice* hand_;
  QComboBox* mode_;
  PresetChoice* preset_;
  QPushButton* startStop_;
  QLabel* whyNot_;
  QToolButton* takeInHand_;
  FeelNotice* notice_;
  HandWorkspace* workspace_;
  Readouts *device_, *felt_, *servo_;
  QLabel *force_, *torque_, *distance_, *minima_, *contacts_, *lead_, *energy_, *clamped_;
  QLabel *reports_, *jitter_, *lost_, *grip_;
  QLabel *rate_, *lateness_, *tick_, *subSteps_, *overruns_, *scheduling_;
  bool isTaken_ = false, isHandEmpty_ = false, hasDevice_ = false;
  DeviceLimits limits_;  ///< Of the device, or of the hand in its place.
};

}  // namespace nearfit::ui
