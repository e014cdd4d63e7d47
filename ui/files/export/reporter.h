#pragma once

#include <QObject>
#include <functional>

#include "core/session/session.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QAction;
class QWidget;

namespace nearfit::ui {

class ReportDialog;
class SceneWork;

/// Writes reports of the scene: asks what they are to hold and where they go, makes them in another thread that takes
/// what time others leave, the servo above all.
class Reporter : public QObject {
  Q_OBJECT

 public:
  /// Returns the moving part's worldFromPart now; anything if there is none.
  using PoseOfMoving = std::function<RigidTransform()>;

  /// @param session, work  Outlive this.
  /// @param window         Parent of dialogs.
  Reporter(Session& session, const SceneWork& work, PoseOfMoving poseOfMoving, QWidget* window,
           QObject* parent);
  ~Reporter() override;

  /// Returns the action *Report…*.
  QAction* action() const noexcept { return action_; }

 signals:
  /// Emitted before a report: numbers that are still being typed count now.
  void sceneNeeded();
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  /// The scene with what is in hand where it is now. If nothing is elsewhere, the scene to the last bit.
  Scene presentScene() const;
  /// True if the scene's file holds the scene, as far as the session knows.
  bool isAsSaved() const;
  void updateAction();
  void askAndWrite();
  void write(const ReportDialog& dialog, const QString& file);

  Session& session_;
  const SceneWork& work_;
  const PoseOfMoving poseOfMoving_;
  QWidget* window_;
  QAction* action_;
  BackgroundTask task_;
  Subscription changes_;
};

}  // namespace nearfit::ui
