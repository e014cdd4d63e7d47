#pragma once

#include <QObject>

#include "core/session/scene_events.h"

class QAction;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class SceneWork;

/// Undo and redo, which name the step that they take back or repeat.
class UndoActions : public QObject {
  Q_OBJECT

 public:
  /// @param session, work  Outlive this.
  UndoActions(Session& session, const SceneWork& work, QObject* parent);

  QAction *undo, *redo;

 signals:
  /// Emitted with a short note for the status bar: what was undone or redone.
  void noted(const QString& text);
  /// Emitted before a step is taken back or repeated: a move that is still settling becomes a step first.
  void sceneNeeded();

 private:
  void update();

  Session& session_;
  const SceneWork& work_;
  Subscription changes_;
};

}  // namespace nearfit::ui
