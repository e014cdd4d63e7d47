#pragma once

#include <QObject>
#include <QPoint>

class QAction;
class QKeyEvent;
class QMouseEvent;
class QRubberBand;

namespace nearfit::ui {

class Selection;
class Viewport;

/// Selects parts by a rectangle: once switched on, the next left drag in the view draws it instead of
/// orbiting, and whatever of a part is seen in it selects the part. As with clicks, Shift adds and Ctrl adds
/// or takes out. The other buttons and the wheel stay the view's, and a tool that takes clicks stays on.
class BoxSelect : public QObject {
  Q_OBJECT

 public:
  /// @param selection, view  Outlive this.
  BoxSelect(Selection& selection, Viewport& view, QObject* parent);

  /// On until a rectangle has been drawn, or Escape is pressed.
  QAction* action() const noexcept { return action_; }

  bool eventFilter(QObject* watched, QEvent* event) override;

 signals:
  void noted(const QString& text);

 private:
  enum class State {
    Off,
    Waiting,  ///< For the drag.
    Dragging,
    Abandoned,  ///< Buttons of a drag that is over are still down: nobody is to take them for a drag.
  };
  void begin();
  void end();
  bool press(const QMouseEvent& event);
  bool release(const QMouseEvent& event);
  bool cancel();
  void take(const QRect& box, Qt::KeyboardModifiers modifiers);

  Selection& selection_;
  Viewport& view_;
  QAction* action_;
  QRubberBand* band_;
  State state_ = State::Off;
  QPoint begin_;
};

}  // namespace nearfit::ui
