#pragma once

#include <QObject>

class QAction;
class QMainWindow;
class QMenu;

namespace nearfit::ui {

class ShortcutsDialog;
class Tour;
class WindowLayout;

/// What makes a user at home in a window: the overview of shortcuts, the theme, the layout, the tour.
class Manners : public QObject {
  Q_OBJECT

 public:
  /// @param view, help  Menus that get the actions.
  Manners(QMainWindow* window, QMenu* view, QMenu* help);

  /// Once the window has all its docks: puts them where they were, and names what nobody has named.
  void settle();

  QAction* tour() const noexcept { return tourAction_; }
  WindowLayout& layout() noexcept { return *layout_; }

 signals:
  /// The tour is to begin: the scene should have something to speak of.
  void tourRequested();

 public slots:
  void beginTour();

 private:
  void addThemes(QMenu* view);

  QMainWindow* window_;
  WindowLayout* layout_ = nullptr;  ///< Once it is settled.
  ShortcutsDialog* shortcuts_;
  Tour* tour_;
  QAction* tourAction_;
};

}  // namespace nearfit::ui
