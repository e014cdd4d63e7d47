#pragma once

#include <QMouseEvent>

#include "core/placing/gizmo_layout.h"
#include "tests/app/desktop/desktop_driver.h"
#include "ui/view3d/gizmo_overlay.h"

namespace nearfit::test {

/// A mouse over the view of the window, and what it finds there.
class ViewDriver {
 public:
  /// @param driver  Outlives this.
  explicit ViewDriver(DesktopDriver& driver) : d_(driver) {}

  /// Goes to a view and waits until it is drawn.
  void look(const char* action) {
    const int before = view().pictureCount();
    d_.choose(action);
    QTRY_VERIFY(view().pictureCount() > before);
  }
  ui::Viewport& view() { return d_.window().viewport(); }
  ui::GizmoOverlay& overlay() { return *d_.widget<ui::GizmoOverlay>("gizmo"); }
  QString readout() { return d_.text("dragReadout"); }

  QPoint seen(const glm::dvec3& point) {
    const glm::dvec2 pixel = view().projection().pixelOf(point).value();
    return {static_cast<int>(std::lround(pixel.x)), static_cast<int>(std::lround(pixel.y))};
  }
  /// Where the gizmo shows a handle so that it can be grabbed.
  QPoint handle(GizmoGrip handle) {
    const GizmoLayout& layout = overlay().picture().value().layout;
    for (const GizmoFigure& figure : layout.figures()) {
      if (figure.handle != handle) continue;
      glm::dvec2 middle(0.0);
      for (const glm::dvec2& point : figure.points)
        middle += point / static_cast<double>(figure.points.size());
      if (isRing(handle)) middle = figure.points[figure.points.size() / 3];
      if (layout.pick(glm::round(middle)) != handle) continue;
      return {static_cast<int>(std::lround(middle.x)), static_cast<int>(std::lround(middle.y))};
    }
    throw Error("gizmo", "the handle is not to be seen");
  }

  void send(QEvent::Type type, QPoint at, Qt::KeyboardModifiers keys = {},
            Qt::MouseButton button = Qt::LeftButton) {
    const bool isMove = type == QEvent::MouseMove;
    const Qt::MouseButtons down = type == QEvent::MouseButtonRelease ? Qt::NoButton : held_;
    QMouseEvent event(type, at, view().mapToGlobal(at), isMove ? Qt::NoButton : button, down, keys);
    QApplication::sendEvent(&view(), &event);
  }
  void press(QPoint at, Qt::KeyboardModifiers keys = {}, Qt::MouseButton button = Qt::LeftButton) {
    held_ = button;
    send(QEvent::MouseButtonPress, at, keys, button);
  }
  void moveTo(QPoint at, Qt::KeyboardModifiers keys = {}) {
    send(QEvent::MouseMove, at, keys);
    QCoreApplication::processEvents();
  }
  void release(QPoint at, Qt::KeyboardModifiers keys = {}, Qt::MouseButton button = Qt::LeftButton) {
    send(QEvent::MouseButtonRelease, at, keys, button);
    held_ = Qt::NoButton;
  }
  void drag(QPoint from, QPoint way, Qt::KeyboardModifiers keys = {},
            Qt::MouseButton button = Qt::LeftButton) {
    press(from, keys, button);
    for (int i = 1; i <= 10; ++i)
      moveTo(from + way * i / 10, keys);
    release(from + way, keys, button);
  }

 private:
  DesktopDriver& d_;
  Qt::MouseButtons held_ = Qt::NoButton;
};

}  // namespace nearfit::test
