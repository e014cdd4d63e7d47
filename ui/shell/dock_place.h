#pragma once

#include <QToolButton>

class QDockWidget;

namespace nearfit::ui {

/// Brings a dock that was just shown before the other tabs of its place, once it is laid out. The first time it gets the
/// height that its content asks for, though no more than a share of the window's; a higher one stays.
void bringToFront(QDockWidget& dock);

/// A button that shows and hides a dock; one that is only behind another tab comes to the front.
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
