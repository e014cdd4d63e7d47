#pragma once

#include <QList>
#include <QObject>

#include "core/session/scene_events.h"

class QAction;
class QMenu;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class MinimaMenu;
class Selection;
class Viewport;

/// What the user can choose about the view: where it looks from, and what it draws besides the parts.
class ViewActions : public QObject {
  Q_OBJECT

 public:
  /// @param session, selection, view  Outlive this.
  /// @param window                    Becomes the parent.
  ViewActions(Session& session, Selection& selection, Viewport& view, QWidget* window);

  QAction *fit, *fitSelection;

  /// Returns the actions that turn to a standard view.
  const QList<QAction*>& views() const noexcept { return views_; }
  /// Returns the switches of what is drawn.
  const QList<QAction*>& switches() const noexcept { return switches_; }
  /// Returns the menu of what is drawn of minima.
  QMenu* minimaMenu() const noexcept;

 private:
  void setUpLooking();
  void setUpDrawing();
  void update();

  Session& session_;
  Selection& selection_;
  Viewport& view_;
  MinimaMenu* minima_;
  QList<QAction*> views_, switches_;
  Subscription changes_;
};

}  // namespace nearfit::ui
