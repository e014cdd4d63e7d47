#pragma once

#include <QToolButton>

class QAction;
class QDockWidget;

namespace nearfit::ui {

/// Brings a dock that was just shown before the other tabs of its place, once it is laid out. The first time it gets the
/// height that its content asks for, though no more than a share of the window's; a higher one stays.
void bringToFront(QDockWidget& dock);

/// Shows a hidden dock, hides one that is seen, and brings one to the front that is only behind another tab.
void showHideOrRaise(QDockWidget& dock);

/// Returns a checkable entry for menus that does that; checked while the dock is open. Named as the dock, with "Entry".
/// @param dock  Becomes its parent.
QAction* makePanelEntry(QDockWidget& dock);

/// A button that does that.
class DockButton : public QToolButton {
 public:
  /// @param dock    Outlives this.
  /// @param parent  Of the button.
  DockButton(QDockWidget& dock, QWidget* parent);

 protected:
  void nextCheckState() override;

 private:
  QDockWidget& dock_;
};

}  // namespace nearfit::ui
