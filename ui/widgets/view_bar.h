#pragma once

#include <QFrame>

namespace nearfit::ui {

/// Base of a tool's bar: prompts and inputs in a frame at the lower edge of the view. Bars shown together are
/// stacked, the oldest lowest. The view gets a QEvent::LayoutRequest when bars have moved.
class ViewBar : public QFrame {
  Q_OBJECT

 public:
  /// @param view  The parent.
  /// @param name  The object name; the style sheet goes by it.
  ViewBar(QWidget* view, const QString& name);

  bool eventFilter(QObject* watched, QEvent* event) override;

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  /// Resizes the bar to changed content and moves it into place.
  void place();

 private:
  void placeAll();
};

}  // namespace nearfit::ui
