#include "ui/view3d/hand_drag.h"

#include <QMouseEvent>
#include <QWheelEvent>
#include <QWidget>
#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <vtkCamera.h>

namespace nearfit::ui {
namespace {

constexpr double kPi = std::numbers::pi;
/// A wheel notch moves the point as far as a drag of this many pixels.
constexpr double kNotch = 15.0, kDegreesPerNotch = 120.0;  // Qt counts eighths of a degree; a notch is 15.

glm::dvec3 vectorOf(const double* v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

HandDrag::HandDrag(QWidget& view, vtkCamera& camera) : QObject(&view), view_(view), camera_(camera) {
  view.installEventFilter(this);
}

HandDrag::Frame HandDrag::frame() const {
  Frame is{};
  is.away = vectorOf(camera_.GetDirectionOfProjection());
  is.right = glm::normalize(glm::cross(is.away, vectorOf(camera_.GetViewUp())));
  is.up = glm::cross(is.right, is.away);
  const double height = std::max(view_.height(), 1);
  const double depth = glm::dot(*point_ - vectorOf(camera_.GetPosition()), is.away);
  const double half = camera_.GetParallelProjection() != 0
                          ? camera_.GetParallelScale()
                          : depth * std::tan(camera_.GetViewAngle() * kPi / 360.0);
  // A point behind the eye is not seen, so it does not move.
  is.metresPerPixel = std::max(2.0 * half / height, 0.0);
  return is;
}

bool HandDrag::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::MouseButtonPress:
      return press(*static_cast<QMouseEvent*>(event));
    case QEvent::MouseMove:
      return move(*static_cast<QMouseEvent*>(event));
    case QEvent::MouseButtonRelease: {
      if (static_cast<QMouseEvent*>(event)->button() != button_ || button_ == Qt::NoButton) return false;
      button_ = Qt::NoButton;
      return true;
    }
    case QEvent::Wheel:
      return wheel(*static_cast<QWheelEvent*>(event));
    default:
      return QObject::eventFilter(watched, event);
  }
}

bool HandDrag::press(const QMouseEvent& event) {
  // A second button does not disturb a drag.
  if (button_ != Qt::NoButton) return true;
  const bool isDrag = event.button() == Qt::LeftButton || event.button() == Qt::RightButton;
  if (!point_ || !isDrag || !event.modifiers().testFlag(Qt::ShiftModifier)) return false;
  button_ = event.button();
  last_ = event.pos();
  return true;
}

bool HandDrag::move(const QMouseEvent& event) {
  if (button_ == Qt::NoButton) return false;
  const QPoint way = event.pos() - last_;
  last_ = event.pos();
  if (!point_ || way.isNull()) return true;
  const Frame is = frame();
  if (button_ == Qt::LeftButton) {
    const glm::dvec3 shift = is.metresPerPixel * (double(way.x()) * is.right - double(way.y()) * is.up);
    *point_ += shift;
    emit dragged(shift, glm::dquat(1.0, 0.0, 0.0, 0.0));
  } else {
    // Half a turn over the view's height; the near side follows the pointer.
    const double perPixel = kPi / std::max(view_.height(), 1);
    emit dragged(glm::dvec3(0.0),
                 glm::angleAxis(perPixel * way.x(), is.up) * glm::angleAxis(perPixel * way.y(), is.right));
  }
  return true;
}

bool HandDrag::wheel(const QWheelEvent& event) {
  if (!point_ || !event.modifiers().testFlag(Qt::ShiftModifier)) return false;
  // Some systems turn Shift+wheel into a horizontal wheel.
  const QPoint angle = event.angleDelta();
  const double notches = (angle.y() != 0 ? angle.y() : angle.x()) / kDegreesPerNotch;
  const Frame is = frame();
  const glm::dvec3 shift = notches * kNotch * is.metresPerPixel * is.away;
  *point_ += shift;
  emit dragged(shift, glm::dquat(1.0, 0.0, 0.0, 0.0));
  return true;
}

}  // namespace nearfit::ui
