#pragma once

#include <QMainWindow>
#include <functional>
#include <memory>
#include <optional>

#include "core/haptics/rate_settings.h"
#include "core/servo/servo_tick.h"
#include "core/session/session.h"
#include "ui/model/device_choice.h"
#include "ui/model/servo_status.h"

class QDockWidget;

namespace nearfit::ui {

class Actions;
class AlignTool;
class Document;
class DropTool;
class FeelDialog;
class FeelPanel;
class WindowShell;
class MoveGuard;
class PartsPanel;
class PlacingTools;
class PosePanel;
class PresetStore;
class Recovery;
class Selection;
class ShownPoses;
class StatusReadout;
class TreeActions;
class TakingAway;
class Viewport;
class WelcomeCard;
struct Failure;

/// The main window of the desktop application. Connects view and panels, and turns user actions into session
/// commands. Does not own the servo: requests it by signals and shows its state through slots.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// @param session  Outlives the window.
  explicit MainWindow(Session& session, QWidget* parent = nullptr);
  ~MainWindow() override;

  Document& document() noexcept { return *document_; }
  Viewport& viewport() noexcept { return *viewport_; }
  Selection& selection() noexcept { return *selection_; }
  TakingAway& takingAway() noexcept { return *takingAway_; }
  /// Sends failures to `sink` instead of a message box, for unattended runs.
  void setFailureSink(std::function<void(const Failure&)> sink);
  /// Sets the scene that "Open demo" opens; empty disables the action.
  void setDemoScene(const QString& file);
  /// Opens the demo as an unnamed scene. False if there is none, the user cancels, or something is loading.
  bool openDemo();
  /// Starts the tour of the window; with an empty scene it opens the demo first.
  void beginTour();
  /// Keeps journals of unsaved work in that folder, and offers to restore what earlier runs left there.
  void protectWork(const std::filesystem::path& recoveryFolder);
  /// Sets the text of the About box.
  void setAboutText(const QString& text) { aboutText_ = text; }

 public slots:
  /// Lists the devices that can be chosen as the hand.
  void showDevices(const QVector<nearfit::ui::DeviceChoice>& devices);
  /// Shows the servo's state. When the servo stops, it also removes the last snapshot.
  void showServoStatus(const nearfit::ui::ServoStatus& status);
  /// Shows a snapshot of the part in hand.
  void showSnapshot(const nearfit::ServoSnapshot& snapshot);
  /// Shows a failure without blocking, or passes it to the failure sink.
  void showFailure(const nearfit::ui::Failure& failure);
  /// Shows a note in the status bar for a few seconds.
  void showNote(const QString& text);
  /// Chooses a device as the hand and starts the servo with it.
  /// @param device  DeviceChoice::id, or "replay:FILE" for a recording.
  void feelWith(const QString& device);
  /// Builds missing hierarchies of the scene's parts behind a progress dialog, then emits hierarchiesReady();
  /// emits servoStopRequested() if the user cancels or that fails.
  void prepareHierarchies();

 signals:
  /// Emitted when the servo is to start; all hierarchies are ready.
  /// @param device  DeviceChoice::id if `hand` is Device.
  void servoStartRequested(nearfit::ui::Hand hand, const QString& device);
  /// Emitted when the user arms or disarms the device in hand.
  void armRequested(bool isArmed);
  /// Emitted when the user engages or releases the clutch.
  void clutchRequested(bool isClutched);
  /// Emitted when the user asks to calibrate the device in hand.
  void calibrateRequested();
  /// Emitted when the user resets a faulted device.
  void resetRequested();
  /// Emitted when the servo is to stop. The receiver must put the part down before it returns.
  void servoStopRequested();
  /// Emitted when prepareHierarchies() has succeeded.
  void hierarchiesReady();
  /// Emitted before the scene is saved or left. The receiver must put the pose in hand into the session
  /// before it returns; the servo keeps running.
  void poseInHandRequested();
  /// Emitted when the user changes how a space mouse drives.
  void rateChanged(const nearfit::RateSettings& settings);
  /// Emitted when the manual hand moves; the pose is where it wants the part.
  void handMoved(const nearfit::RigidTransform& worldFromPart);

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  QDockWidget* addDock(const QString& name, const QString& title, QWidget* content, Qt::DockWidgetArea area);
  void setUpPanels();
  void setUpAligning();
  void setUpInspecting();
  void updateAligning();
  void setUpTakingAway();
  void connectFileActions();
  void setUpFiles();
  void connectEditActions();
  void connectViewActions();
  void connectPanels();
  void connectFeel();
  void connectPresets();
  void connectHand();
  void connectPlacing();
  void connectMoveGuard();
  /// Tells the placing tools and the move guard what the servo holds.
  void showHeld();

  void showScene();
  /// Updates the mark of unsaved changes in the title.
  void showModified();
  void showSelection();
  void updateActions();
  /// Runs a session command; on an exception shows the failure, and the scene anew.
  void attempt(const QString& what, const std::function<void()>& command);

  /// The current part: the one that numbers, keys and most commands act on.
  std::optional<PartId> selected() const;
  /// True if the servo holds that part.
  bool holds(std::optional<PartId> part) const;
  /// Returns where the moving part is now (worldFromPart); the identity if there is none.
  RigidTransform poseOfMoving() const;
  void requestStart();
  /// Asks for the file of a recorded hand; false if the user cancels.
  bool askForRecording();
  void takeInHand(std::optional<PartId> part);
  /// Locks or unlocks. Locking the moving part puts it down; refused while it is being felt.
  void lockNodes(const SceneNodes& nodes, bool isLocked);
  void deleteSelected();
  void recolourSelected();
  void moveSelected(const RigidTransform& worldFromPart);
  /// Moves the selected part, or the manual hand, by a step of the pose panel along or about a world axis.
  void nudge(const glm::dvec3& direction);
  void turn(const glm::dvec3& axis);
  void stepSelected(const glm::dvec3& shift, const glm::dquat& turn);
  bool isHandManual() const;
  /// Moves the manual hand, except along or about axes that the scene locks.
  void moveHand(const RigidTransform& worldFromPart);
  /// Moves the manual hand and turns it about the part's centre of mass; does nothing with other hands.
  void dragHand(const glm::dvec3& shift, const glm::dquat& turn);
  void letGo();
  /// @param label  Name of the undo step; empty: derived from the change.
  void changeHaptics(const HapticSettings& settings, const QString& label = {});
  void restartServo();
  void showAbout();

  Session& session_;
  Selection* selection_;
  ShownPoses* poses_;
  Actions* actions_;
  MoveGuard* guard_;
  TreeActions* treeActions_;
  Viewport* viewport_;
  std::unique_ptr<Document> document_;
  PartsPanel* partsPanel_;
  PosePanel* posePanel_;
  FeelPanel* feelPanel_;
  FeelDialog* feelDialog_;
  PresetStore* presets_;
  AlignTool* align_ = nullptr;
  DropTool* drop_ = nullptr;
  StatusReadout* readout_;
  WindowShell* manners_;
  WelcomeCard* welcome_;
  PlacingTools* placing_;
  Recovery* recovery_ = nullptr;  ///< Null: work is not protected.
  TakingAway* takingAway_;
  std::function<void(const Failure&)> failureSink_;
  QString demoScene_, aboutText_;
  ServoStatus servo_;
  struct WantedHand {
    Hand hand = Hand::Scripted;
    QString device;
  };
  /// Set while a start waits for hierarchies. Keeps the device chosen: if it is unplugged meanwhile, no
  /// other one takes its place.
  std::optional<WantedHand> wanted_;
  glm::dvec3 centreInPart_{0.0};  ///< Centre of mass of the part in hand [m]; the mouse turns about it.
  RigidTransform handPose_;       ///< worldFromPart that the manual hand wants; the part may lag behind.
  Subscription viewChanges_, panelChanges_;
};

}  // namespace nearfit::ui
