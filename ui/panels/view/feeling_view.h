#pragma once

#include <QObject>

class QAction;
class QMenu;
class QWidget;

namespace nearfit::ui {

class Viewport;

/// What the user chooses about pictures while a part is felt: the legend, and how much of large parts is drawn. Kept
/// between runs.
class FeelingView : public QObject {
  Q_OBJECT

 public:
  /// @param view    Outlives this.
  /// @param window  Becomes the parent.
  FeelingView(Viewport& view, QWidget* window);

  /// Returns the switch that shows and hides the legend.
  QAction* legend() const noexcept { return legend_; }
  /// Returns the menu of qualities.
  QMenu* qualityMenu() const noexcept { return quality_; }

 private:
  void setUpQualities();

  Viewport& view_;
  QAction* legend_;
  QMenu* quality_;
};

}  // namespace nearfit::ui
