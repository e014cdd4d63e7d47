#pragma once

#include <QFrame>
#include <QWidget>

namespace nearfit::ui {

/// A view and, in a strip of their own below it, the bars of its tools, which cover nothing of it.
class ViewArea : public QWidget {
  Q_OBJECT

 public:
  /// Takes the view as its child. With bars the view may become lower than its min height.
  ViewArea(QWidget* view, QWidget* parent);

  /// Adds a bar between the view and the bars that were added earlier.
  void add(QWidget* bar);
};

/// Base of a tool's bar: prompts and inputs in a strip below the view. Keys that the bar has no use for go to the view, and
/// so does the focus when the bar is hidden.
class ViewBar : public QFrame {
  Q_OBJECT

 public:
  /// @param view  In a ViewArea, which becomes the parent.
  /// @param name  The object name; the style sheet goes by it.
  ViewBar(QWidget* view, const QString& name);

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  /// Gives the bar the height of its new content at once, so that the view does not change later, between two clicks.
  void place();

 private:
  QWidget* view_;
};

}  // namespace nearfit::ui
