#pragma once

#include <QObject>
#include <QString>
#include <QVector>
#include <optional>

#include "core/haptics/haptic_settings.h"
#include "core/haptics/rate_settings.h"
#include "core/session/scene_events.h"
#include "ui/model/device_choice.h"
#include "ui/model/servo_status.h"
#include "ui/widgets/error_box.h"

class QAction;
class QWidget;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class FeelDialog;
class FeelPanel;
class HandState;
class PresetStore;
class SceneWork;

/// Who holds the moving part, and how contact feels: the feel panel, the feel settings and the actions for
/// both. Does not own the servo, but requests it by signals.
class FeelControl : public QObject {
  Q_OBJECT

 public:
  /// @param session, hand, work  Outlive this.
  /// @param window               The parent of this, of the panel and of dialogs.
  FeelControl(Session& session, const HandState& hand, SceneWork& work, QWidget* window);

  QAction *start, *stop, *clutch, *settings;

  FeelPanel& panel() noexcept { return *panel_; }
  /// Reads the user's presets; once, after failed() and noted() are connected.
  void loadPresets();
  /// Closes the feel settings, which commits a number being typed there.
  void closeSettings();

 public slots:
  /// Lists the devices that can be chosen as the hand.
  void showDevices(const QVector<nearfit::ui::DeviceChoice>& devices);
  /// Chooses the scripted hand; starts nothing.
  void chooseScriptedHand();
  /// Chooses a device as the hand and starts the servo with it.
  /// @param device  DeviceChoice::id, or "replay:FILE" for a recording.
  void feelWith(const QString& device);
  /// Builds missing hierarchies of the scene's parts behind a progress dialog, then emits hierarchiesReady();
  /// emits servoStopRequested() if the user cancels or that fails.
  void prepareHierarchies();

 signals:
  /// Emitted before the servo starts: numbers that are still being typed count now.
  void sceneNeeded();
  /// Emitted when the servo is to start; all hierarchies are ready.
  /// @param device  DeviceChoice::id if `hand` is Device.
  void servoStartRequested(nearfit::ui::Hand hand, const QString& device);
  /// Emitted when the servo is to stop. The receiver must put the part down before it returns.
  void servoStopRequested();
  /// Emitted when prepareHierarchies() has succeeded.
  void hierarchiesReady();
  /// Emitted when the user arms or disarms the device in hand.
  void armRequested(bool isArmed);
  /// Emitted when the user engages or releases the clutch.
  void clutchRequested(bool isClutched);
  /// Emitted when the user asks to calibrate the device in hand.
  void calibrateRequested();
  /// Emitted when the user resets a faulted device.
  void resetRequested();
  /// Emitted when the user changes how a space mouse drives.
  void rateChanged(const nearfit::RateSettings& settings);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  struct WantedHand {
    Hand hand = Hand::Scripted;
    QString device;
  };
  void makeActions();
  void makePanel();
  void connectPanel();
  void connectSettings();
  void connectHand();
  void updateActions();
  /// Returns why nothing can be felt now, as a sentence for the user; empty if it can.
  QString whyNotFelt() const;
  void showSettings();
  void requestStart();
  void restart();
  /// Goes on with the hand that the user has just chosen.
  void takeChosenHand();
  /// Asks for the file of a recorded hand; false if the user cancels.
  bool askForRecording();
  /// @param label  Name of the undo step; empty: derived from the change.
  void change(const HapticSettings& settings, const QString& label = {});
  void usePreset(const HapticSettings& settings, const QString& name);

  Session& session_;
  const HandState& hand_;
  SceneWork& work_;
  QWidget* window_;
  PresetStore* presets_;
  FeelDialog* dialog_;
  FeelPanel* panel_ = nullptr;
  /// Set while a start waits for hierarchies. Keeps the device chosen: if it is unplugged meanwhile, no
  /// other one takes its place.
  std::optional<WantedHand> wanted_;
  Subscription changes_;
};

}  // namespace nearfit::ui
