#pragma once

#include <QAction>
#include <functional>

#include "core/session/scene_events.h"
#include "core/session/script_recorder.h"
#include "ui/widgets/error_box.h"

namespace nearfit::ui {

/// Starts and stops recording the session's commands as a script. Its text says how many have been recorded. Another
/// scene, and the end of the window, end the recording.
class CommandRecordAction : public QAction {
  Q_OBJECT

 public:
  /// @param session  Outlives this.
  /// @param window   The parent, and that of dialogs.
  CommandRecordAction(Session& session, QWidget* window);
  ~CommandRecordAction() override;

 signals:
  /// Emitted before a recording starts or stops: a move that is still settling becomes a step first.
  void sceneNeeded();
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);

 private:
  /// Asks for a file and starts.
  void askAndStart();
  void stop();
  /// Takes in what the session did.
  void follow();
  void update();
  /// Runs `act` and emits failed() if it throws. Returns true if it did not.
  bool attempt(const QString& what, const std::function<void()>& act);

  QWidget* window_;
  ScriptRecorder recorder_;
  Subscription changes_;
};

}  // namespace nearfit::ui
