#pragma once

#include <QObject>
#include <functional>
#include <string>

#include "core/session/scene_events.h"

class QAction;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class HandState;
class SceneWork;

/// Undo and redo, which name the step that they take back or repeat.
class UndoActions : public QObject {
  Q_OBJECT

 public:
  /// @param session, work, hand  Outlive this.
  UndoActions(Session& session, const SceneWork& work, const HandState& hand, QObject* parent);

  QAction *undo, *redo;

 signals:
  /// Emitted with a short note for the status bar: what was undone or redone, and that it ended feeling.
  void noted(const QString& text);
  /// Emitted before a step is taken back or repeated: a move that is still settling becomes a step first.
  void sceneNeeded();

 private:
  /// Takes a step and notes it.
  /// @param pattern  Of the note, with a place for the step's name.
  /// @param label  Of the step.
  void step(const QString& pattern, const std::string& label, const std::function<void()>& act);
  void update();

  Session& session_;
  const SceneWork& work_;
  const HandState& hand_;
  Subscription changes_;
};

}  // namespace nearfit::ui
