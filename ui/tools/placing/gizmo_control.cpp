#include "ui/tools/placing/gizmo_control.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <numbers>
#include <optional>
#include <utility>

#include "ui/view3d/gizmo_overlay.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/preferences.h"

namespace nearfit::ui {
namespace {

/// Distance at which a press becomes a drag instead of a click [pixels].
constexpr int kDragDistance = 4;

glm::dvec2 pixelOf(const QPoint& point) {
  return {point.x(), point.y()};
}

/// Returns the number typed so far, with a decimal point or comma; nullopt if it is none yet.
std::optional<double> numberOf(QString typed) {
  bool isNumber = false;
  const double number = typed.replace(QChar(','), QChar('.')).toDouble(&isNumber);
  return isNumber ? std::optional(number) : std::nullopt;
}

}  // namespace

GizmoControl::GizmoControl(Viewport& view, const QString& name, const QString& readout)
    : QObject(&view), view_(view), overlay_(new GizmoOverlay(&view)), readout_(new DragReadout(&view)) {
  overlay_->setObjectName(name);
  readout_->setObjectName(readout);
  view.installEventFilter(this);
  connect(&view, &Viewport::drawn, this, &GizmoControl::refresh);
}

void GizmoControl::setFrame(const std::optional<GizmoFrame>& frame) {
  const bool isSame = frame.has_value() == frame_.has_value() &&
                      (!frame || (frame->pivot == frame_->pivot && frame->axes == frame_->axes));
  frame_ = frame;
  if (!isSame) refresh();
}

void GizmoControl::setMode(GizmoMode mode) {
  mode_ = mode;
  refresh();
}

void GizmoControl::setSnapping(bool isSnapping) {
  isSnapping_ = isSnapping;
  if (isDragging()) follow();
}

SnapSteps GizmoControl::steps() const {
  return isSnapping_ != isControlHeld_ ? steps_ : SnapSteps{};
}

bool GizmoControl::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonDblClick:
      return press(*static_cast<QMouseEvent*>(event));
    case QEvent::MouseMove:
      return move(*static_cast<QMouseEvent*>(event));
    case QEvent::MouseButtonRelease:
      return release(*static_cast<QMouseEvent*>(event));
    case QEvent::Wheel:
      return isDragging();
    case QEvent::ShortcutOverride:
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
      return isDragging() && key(*event);
    case QEvent::Leave:
      if (!isDragging()) hover({-1000, -1000});
      return false;
    default:
      return QObject::eventFilter(watched, event);
  }
}

bool GizmoControl::press(const QMouseEvent& event) {
  if (isDragging()) {
    // Any other button cancels the drag.
    if (event.button() != Qt::LeftButton) cancel();
    return true;
  }
  if (pressed_) return true;
  if (isSwallowing_ && event.button() != Qt::LeftButton) return true;
  isSwallowing_ = false;
  const bool isFree = !(event.modifiers() & (Qt::ShiftModifier | Qt::AltModifier));
  if (event.button() != Qt::LeftButton || !frame_ || mode_ == GizmoMode::Hidden || !isFree) return false;
  pointer_ = event.pos();
  const GizmoGrip handle = GizmoLayout(view_.projection(), *frame_, mode_).pick(pixelOf(event.pos()));
  std::optional<glm::dvec3> grabbed;
  if (handle == GizmoGrip::None && grab_) grabbed = grab_(event.pos());
  if (handle == GizmoGrip::None && !grabbed) return false;
  pressed_ = {event.pos(), handle, grabbed};
  return true;
}

bool GizmoControl::move(const QMouseEvent& event) {
  pointer_ = event.pos();
  isControlHeld_ = event.modifiers().testFlag(Qt::ControlModifier);
  if (!event.buttons().testFlag(Qt::LeftButton)) letGo();
  if (isSwallowing_) return true;
  if (pressed_ && (event.pos() - pressed_->at).manhattanLength() >= kDragDistance) {
    const Pressed pressed = *std::exchange(pressed_, std::nullopt);
    begin(pressed);
  }
  if (isDragging()) follow();
  if (isDragging() || pressed_ || isSwallowing_) return true;
  // With a button down the pointer orbits or leads the hand, also from a handle; it highlights nothing.
  if (event.buttons() != Qt::NoButton) {
    if (std::exchange(hot_, GizmoGrip::None) != GizmoGrip::None) refresh();
    return false;
  }
  hover(event.pos());
  // A handle hides what lies under it.
  return hot_ != GizmoGrip::None;
}

bool GizmoControl::release(const QMouseEvent& event) {
  if (event.button() != Qt::LeftButton) return isDragging() || isSwallowing_;
  if (std::exchange(isSwallowing_, false)) return true;
  if (const std::optional<Pressed> pressed = std::exchange(pressed_, std::nullopt)) {
    view_.pickAt(pressed->at, event.modifiers());
    return true;
  }
  if (!isDragging()) return false;
  pointer_ = event.pos();
  follow();
  letGo();
  hover(event.pos());
  return true;
}

/// Handles the release of the button, even if its event was missed.
void GizmoControl::letGo() {
  isSwallowing_ = false;
  pressed_.reset();
  if (!isDragging()) return;
  forgetDrag();
  emit ended();
}

bool GizmoControl::key(QEvent& event) {
  const auto& pressed = static_cast<const QKeyEvent&>(event);
  if (pressed.key() == Qt::Key_Escape) {
    if (event.type() == QEvent::KeyPress) cancel();
    event.accept();
    return true;
  }
  if (isOfAmount(pressed)) {
    // Accepted before it is a shortcut: digits choose a view.
    if (event.type() == QEvent::KeyPress) type(pressed);
    event.accept();
    return true;
  }
  if (pressed.key() != Qt::Key_Control || event.type() == QEvent::ShortcutOverride) return false;
  isControlHeld_ = event.type() == QEvent::KeyPress;
  follow();
  return true;
}

bool GizmoControl::isOfAmount(const QKeyEvent& event) const {
  if (event.modifiers() & (Qt::ControlModifier | Qt::AltModifier | Qt::MetaModifier)) return false;
  switch (event.key()) {
    case Qt::Key_Backspace:
    case Qt::Key_Return:
    case Qt::Key_Enter:
      return !typed_.isEmpty();
    case Qt::Key_Minus:
    case Qt::Key_Period:
    case Qt::Key_Comma:
      return true;
    default:
      return event.key() >= Qt::Key_0 && event.key() <= Qt::Key_9;
  }
}

void GizmoControl::type(const QKeyEvent& event) {
  constexpr int kMaxLength = 12;
  switch (event.key()) {
    case Qt::Key_Return:
    case Qt::Key_Enter:
      return apply();
    case Qt::Key_Backspace:
      typed_.chop(1);
      break;
    case Qt::Key_Minus:
      if (typed_.startsWith(QChar('-')))
        typed_.remove(0, 1);
      else
        typed_.prepend(QChar('-'));
      break;
    default:
      if (typed_.size() < kMaxLength) typed_ += QChar(event.key());
  }
  const std::optional<double> number = numberOf(typed_);
  constexpr double kDegree = std::numbers::pi / 180.0;
  const double unit = isRing(drag_->handle()) ? kDegree : metresOf(Preferences::lengthUnit());
  drag_->setAmount(number ? std::optional(*number * unit) : std::nullopt);
  follow();
  refresh();
}

void GizmoControl::apply() {
  isSwallowing_ = true;
  forgetDrag();
  emit ended();
}

QString GizmoControl::typedText() const {
  const GizmoGrip handle = drag_->handle();
  const QString axis =
      isArrow(handle) ? QStringLiteral("XYZ").mid(axisOf(handle), 1) + QChar(' ') : QString();
  const QString unit =
      isRing(handle) ? QString(QChar(0xB0)) : QChar(' ') + symbolOf(Preferences::lengthUnit());
  return axis + typed_ + QChar('_') + unit;
}

void GizmoControl::begin(const Pressed& pressed) {
  if (!frame_) return;
  const GizmoGrip handle = pressed.grabbed ? GizmoGrip::MoveFree : pressed.handle;
  drag_.emplace(view_.projection(), *frame_, handle, pixelOf(pressed.at), pressed.grabbed);
  reached_ = {};
  note_.clear();
  hot_ = handle;
  emit began(handle);
}

void GizmoControl::follow() {
  drag_->moveTo(view_.projection(), pixelOf(pointer_));
  emit dragged(drag_->motion(steps()));
}

void GizmoControl::showReached(const RigidTransform& motion, const QString& note) {
  if (!isDragging()) return;
  reached_ = motion;
  note_ = note;
  refresh();
}

void GizmoControl::cancel() {
  abandon();
  emit cancelled();
}

void GizmoControl::abandon() {
  if (!isDragging()) return;
  isSwallowing_ = true;
  forgetDrag();
}

void GizmoControl::forgetDrag() {
  drag_.reset();
  typed_.clear();
  hot_ = GizmoGrip::None;
  readout_->hide();
  refresh();
}

void GizmoControl::hover(const QPoint& pointer) {
  if (isDragging() || !frame_) return;
  const GizmoGrip under = GizmoLayout(view_.projection(), *frame_, mode_).pick(pixelOf(pointer));
  if (std::exchange(hot_, under) != under) refresh();
}

void GizmoControl::refresh() {
  if (!frame_ || mode_ == GizmoMode::Hidden) {
    hot_ = GizmoGrip::None;
    overlay_->clear();
    return;
  }
  const ViewProjection view = view_.projection();
  GizmoPicture picture{GizmoLayout(view, *frame_, mode_), hot_, isDragging(), std::nullopt};
  if (isDragging()) {
    const glm::dvec3 shift = drag_->shiftIn(reached_);
    const double angle = drag_->angleIn(reached_);
    picture.guide = gizmoGuide(view, *drag_, shift, angle);
    const double pixel = view.metresPerPixel(drag_->frame().pivot);
    QString text = text_ ? text_() : QString();
    if (text.isEmpty()) text = dragText(*drag_, shift, angle, pixel, Preferences::lengthUnit());
    const QString hint = tr("Enter applies, Esc cancels");
    if (typed_.isEmpty())
      readout_->showAt(pointer_, text, note_);
    else
      readout_->showAt(pointer_, typedText(), note_.isEmpty() ? hint : note_);
  }
  overlay_->showPicture(std::move(picture));
}

}  // namespace nearfit::ui
