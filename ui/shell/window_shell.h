#pragma once

#include <QObject>

class QAction;
class QMainWindow;
class QMenu;

namespace nearfit::ui {

class ShortcutsDialog;
class Tour;
class WindowLayout;

/// Conveniences of a window: the overview of shortcuts, the theme, the layout, the tour.
class WindowShell : public QObject {
  Q_OBJECT

 public:
  /// @param view  Menu that receives the actions on theme and layout.
  /// @param help  Menu that receives the actions on tour and shortcuts.
  WindowShell(QMainWindow* window, QMenu* view, QMenu* help);

  /// Call it once the window has all its docks: restores the layout and names unnamed fields.
  void settle();

  /// Returns the action that starts the tour.
  QAction* tour() const noexcept { return tourAction_; }
  /// Returns the layout; only after settle().
  WindowLayout& layout() noexcept { return *layout_; }

 signals:
  /// Emitted when the user asks for the tour: the scene should have something to show.
  void tourRequested();

 public slots:
  /// Shows the tour.
  void beginTour();

 private:
  void addThemes(QMenu* view);

  QMainWindow* window_;
  WindowLayout* layout_ = nullptr;  ///< Null until settle().
  ShortcutsDialog* shortcuts_;
  Tour* tour_;
  QAction* tourAction_;
};

}  // namespace nearfit::ui
