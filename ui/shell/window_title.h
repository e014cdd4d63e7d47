#pragma once

#include <QObject>

#include "core/session/scene_events.h"

class QMainWindow;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class HandState;

/// The window's title: the name of the scene, and a mark if it is not saved. A part in hand that has moved is
/// not saved either, although the session does not have its pose yet.
class WindowTitle : public QObject {
  Q_OBJECT

 public:
  /// @param session, hand  Outlive this.
  /// @param window         Becomes the parent.
  WindowTitle(Session& session, const HandState& hand, QMainWindow* window);

 private:
  void show();
  /// Updates the mark.
  void showModified();

  Session& session_;
  const HandState& hand_;
  QMainWindow* window_;
  Subscription changes_;
};

}  // namespace nearfit::ui
