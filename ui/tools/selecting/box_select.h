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

/// Selects parts by a rectangle. While on, the next left drag in the view draws one instead of orbiting; it
/// selects every part seen in it. As with clicks, Shift adds and Ctrl adds or removes. Other buttons and the
/// wheel still control the view. A tool that takes clicks stays on.
class BoxSelect : public QObject {
  Q_OBJECT

 public:
  /// @param selection, view  Outlive this.
  BoxSelect(Selection& selection, Viewport& view, QObject* parent);

  /// On until a rectangle has been drawn or Escape is pressed.
  QAction* action() const noexcept { return action_; }

  bool eventFilter(QObject* watched, QEvent* event) override;

 signals:
  /// Emitted with a prompt for the status bar.
  void noted(const QString& text);

 private:
  enum class State {
    Off,
    Waiting,  ///< For a drag.
    Dragging,
    Abandoned,  ///< A drag is over, but buttons are still down: swallow their events.
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
