#pragma once

#include <QMainWindow>
#include <functional>
#include <memory>
#include <optional>

#include "core/haptics/rate_settings.h"
#include "core/haptics/servo_tick.h"
#include "core/session.h"
#include "ui/device_choice.h"
#include "ui/servo_status.h"

class QDockWidget;

namespace nearfit::ui {

class Actions;
class AlignTool;
class Document;
class DropTool;
class FeelDialog;
class FeelPanel;
class Manners;
class MoveGuard;
class PartsPanel;
class PlacingTools;
class PosePanel;
class PresetStore;
class Recovery;
class Selection;
class StatusReadout;
class TreeActions;
class TakingAway;
class Viewport;
class WelcomeCard;
struct Failure;

/// The desktop application's window: puts view and panels together and turns what the user does into commands
/// of the session. The servo is someone else's: it is asked for by signals and shown through slots.
class MainWindow : public QMainWindow {
  Q_OBJECT

 public:
  /// @param session  Outlives the window.
  explicit MainWindow(Session& session, QWidget* parent = nullptr);
  ~MainWindow() override;

  Document& document() noexcept { return *document_; }
  Viewport& viewport() noexcept { return *viewport_; }
  Selection& selection() noexcept { return *selection_; }
  PlacingTools& placing() noexcept { return *placing_; }
  TakingAway& takingAway() noexcept { return *takingAway_; }
  /// Failures go to `sink` instead of a message box, for runs that nobody watches.
  void setFailureSink(std::function<void(const Failure&)> sink);
  /// What "Open demo" opens; empty when there is no demo.
  void setDemoScene(const QString& file);
  /// Opens the demo scene, without its file's name. False when it is not.
  bool openDemo();
  /// Explains the window part by part; one without parts opens the demo scene for it.
  void beginTour();
  /// Keeps unsaved work in journals of that folder, and offers what earlier runs left there.
  void protectWork(const std::filesystem::path& recoveryFolder);
  void setAboutText(const QString& text) { aboutText_ = text; }

 public slots:
  void showDevices(const QVector<nearfit::ui::DeviceChoice>& devices);
  void showServoStatus(const nearfit::ui::ServoStatus& status);
  void showSnapshot(const nearfit::ServoSnapshot& snapshot);
  void showFailure(const nearfit::ui::Failure& failure);
  void showNote(const QString& text);
  /// Chooses a device as the hand and takes the moving part in hand with it.
  /// @param device  DeviceChoice::id, or that of a recording.
  void feelWith(const QString& device);
  /// Makes the hierarchies of the scene's parts ready, showing progress, and says so by hierarchiesReady;
  /// stops the servo when the user does not want to wait.
  void prepareHierarchies();

 signals:
  /// @param device  Of the hand of a device: DeviceChoice::id.
  void servoStartRequested(nearfit::ui::Hand hand, const QString& device);
  void armRequested(bool isArmed);
  void clutchRequested(bool isClutched);
  void calibrateRequested();
  void resetRequested();
  void servoStopRequested();
  void hierarchiesReady();
  /// Put the pose in hand into the session, and go on.
  void poseInHandRequested();
  /// How a space mouse drives has been changed.
  void rateChanged(const nearfit::RateSettings& settings);
  /// The manual hand goes there.
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
  /// Tells the tools for placing what the servo holds.
  void showHeld();

  void showScene();
  /// The mark of what is not saved, in the title.
  void showModified();
  void showSelection();
  void updateActions();
  /// Runs a command of the session; a refusal is shown and changes nothing.
  void attempt(const QString& what, const std::function<void()>& command);

  /// The current part: numbers, keys and most commands are about this one.
  std::optional<PartId> selected() const;
  bool holds(std::optional<PartId> part) const;
  RigidTransform poseOf(const Part& part) const;
  void requestStart();
  /// Asks for the file of a recorded hand; false when the user wants none.
  bool askForRecording();
  void takeInHand(std::optional<PartId> part);
  /// What is in hand is put down first, unless it is being felt.
  void lockNodes(const SceneNodes& nodes, bool isLocked);
  void deleteSelected();
  void recolourSelected();
  void moveSelected(const RigidTransform& worldFromPart);
  /// The selected part, or the manual hand, by a step of the pose panel along or about an axis of the world.
  void nudge(const glm::dvec3& direction);
  void turn(const glm::dvec3& axis);
  void stepSelected(const glm::dvec3& shift, const glm::dquat& turn);
  bool isHandManual() const;
  /// Moves the manual hand, but for what the scene locks.
  void moveHand(const RigidTransform& worldFromPart);
  /// The manual hand alone, turned about the part's centre of mass; nothing happens with others.
  void dragHand(const glm::dvec3& shift, const glm::dquat& turn);
  void letGo();
  /// @param label  What undo calls it; empty: by what changes.
  void changeHaptics(const HapticSettings& settings, const QString& label = {});
  void restartServo();
  void showAbout();

  Session& session_;
  Selection* selection_;
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
  Manners* manners_;
  WelcomeCard* welcome_;
  PlacingTools* placing_;
  Recovery* recovery_ = nullptr;  ///< None: work is not protected.
  TakingAway* takingAway_;
  std::function<void(const Failure&)> failureSink_;
  QString demoScene_, aboutText_;
  ServoStatus servo_;
  struct WantedHand {
    Hand hand = Hand::Scripted;
    QString device;
  };
  /// Of a start that waits for hierarchies: a device that leaves meanwhile is missed, not replaced.
  std::optional<WantedHand> wanted_;
  RigidTransform poseInHand_;     ///< Of the part.
  glm::dvec3 centreInPart_{0.0};  ///< Of mass, of the part in hand [m]: the mouse turns it about that.
  RigidTransform handPose_;       ///< Of the manual hand, which the part may stay behind.
};

}  // namespace nearfit::ui
