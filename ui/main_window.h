#pragma once

#include <QMainWindow>
#include <functional>
#include <memory>
#include <optional>

#include "core/haptics/servo_tick.h"
#include "core/session.h"
#include "ui/servo_status.h"

class QDockWidget;

namespace nearfit::ui {

class Actions;
class Document;
class FeelDialog;
class FeelPanel;
class PartsPanel;
class PosePanel;
class StatusReadout;
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
  /// Failures go to `sink` instead of a message box, for runs that nobody watches.
  void setFailureSink(std::function<void(const Failure&)> sink);
  /// What "Open demo" opens; empty when there is no demo.
  void setDemoScene(const QString& file);
  void setAboutText(const QString& text) { aboutText_ = text; }

 public slots:
  void showServoStatus(const nearfit::ui::ServoStatus& status);
  void showSnapshot(const nearfit::ServoSnapshot& snapshot);
  void showFailure(const nearfit::ui::Failure& failure);
  void showNote(const QString& text);
  /// Makes the hierarchies of the scene's parts ready, showing progress, and says so by hierarchiesReady;
  /// stops the servo when the user does not want to wait.
  void prepareHierarchies();

 signals:
  void servoStartRequested(nearfit::ui::Hand hand);
  void servoStopRequested();
  void hierarchiesReady();
  /// Put the pose in hand into the session, and go on.
  void poseInHandRequested();
  /// The manual hand goes there.
  void handMoved(const nearfit::RigidTransform& worldFromPart);

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  QDockWidget* addDock(const QString& name, const QString& title, QWidget* content, Qt::DockWidgetArea area);
  void setUpPanels();
  void connectFileActions();
  void connectEditActions();
  void connectViewActions();
  void connectPanels();
  void connectFeel();

  void showScene();
  void showSelection();
  void updateActions();
  /// Runs a command of the session; a refusal is shown and changes nothing.
  void attempt(const QString& what, const std::function<void()>& command);

  std::optional<PartId> selected() const;
  bool holds(std::optional<PartId> part) const;
  RigidTransform poseOf(const Part& part) const;
  void requestStart();
  void takeInHand(std::optional<PartId> part);
  void deleteSelected();
  void recolourSelected();
  void moveSelected(const RigidTransform& worldFromPart);
  void nudge(const glm::dvec3& direction);
  /// Moves the manual hand, but for what the scene locks.
  void moveHand(const RigidTransform& worldFromPart);
  void letGo();
  void changeHaptics(const HapticSettings& settings);
  void restartServo();
  void exportPlacement();
  void exportPreparedPlacement();
  void showAbout();

  Session& session_;
  Actions* actions_;
  Viewport* viewport_;
  std::unique_ptr<Document> document_;
  PartsPanel* partsPanel_;
  PosePanel* posePanel_;
  FeelPanel* feelPanel_;
  FeelDialog* feelDialog_;
  StatusReadout* readout_;
  WelcomeCard* welcome_;
  std::function<void(const Failure&)> failureSink_;
  QString demoScene_, aboutText_;
  ServoStatus servo_;
  RigidTransform poseInHand_;  ///< Of the part.
  RigidTransform handPose_;    ///< Of the manual hand, which the part may stay behind.
};

}  // namespace nearfit::ui
