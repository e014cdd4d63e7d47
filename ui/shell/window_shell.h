#pragma once

#include <QObject>
#include <QPointer>
#include <QString>

class QAction;
class QMainWindow;
class QMenu;

namespace nearfit::ui {

class FileCommands;
class GuideDialog;
class ShortcutsDialog;
class Tour;
class WindowLayout;

/// Conveniences of a window: the overview of shortcuts, the theme, the layout, the tour, and what the program
/// says about itself.
class WindowShell : public QObject {
  Q_OBJECT

 public:
  /// @param files  Opens the demo for the tour; outlives this.
  /// @param view   Menu that receives the actions on theme and layout.
  /// @param help   Menu that receives the others.
  WindowShell(QMainWindow* window, FileCommands& files, QMenu* view, QMenu* help);

  /// Call it once the window has all its docks: restores the layout and names unnamed fields.
  void settle();

  /// Returns the action that starts the tour.
  QAction* tour() const noexcept { return tourAction_; }
  /// Returns the layout; only after settle().
  WindowLayout& layout() noexcept { return *layout_; }
  /// Sets the text of the About box.
  void setAboutText(const QString& text) { aboutText_ = text; }
  /// Sets the first page of the user's guide; empty disables the action.
  void setGuide(const QString& file);

 public slots:
  /// Starts the tour of the window; with an empty scene it opens the demo first.
  void beginTour();
  /// Ends the tour, as when its scene is gone.
  void endTour();

 private:
  void addThemes(QMenu* view);
  void addHelp(QMenu* help);
  void showTour();
  void showGuide();

  QMainWindow* window_;
  FileCommands& files_;
  QString aboutText_, guideFile_;
  WindowLayout* layout_ = nullptr;  ///< Null until settle().
  ShortcutsDialog* shortcuts_;
  Tour* tour_;
  QAction* tourAction_;
  QAction* guideAction_;
  QPointer<GuideDialog> guide_;
};

}  // namespace nearfit::ui
