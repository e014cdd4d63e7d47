#include "ui/tools/selecting/box_select.h"

#include <QAction>
#include <QApplication>
#include <QMouseEvent>
#include <QRubberBand>
#include <vector>

#include "ui/model/selection.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

BoxSelect::BoxSelect(Selection& selection, Viewport& view, QObject* parent)
    : QObject(parent),
      selection_(selection),
      view_(view),
      action_(new QAction(icon(QStringLiteral("box-select")), tr("Select by &box"), this)),
      band_(new QRubberBand(QRubberBand::Rectangle, &view)) {
  band_->setObjectName(QStringLiteral("selectionBox"));
  action_->setObjectName(QStringLiteral("boxSelect"));
  action_->setCheckable(true);
  action_->setShortcut(QKeySequence(Qt::Key_B));
  setHelp(*action_, tr("Drag a box to select the parts seen in it; Shift adds, Ctrl adds or removes"));
  connect(action_, &QAction::toggled, this, [this](bool isOn) { isOn ? begin() : end(); });
}

void BoxSelect::begin() {
  // Each time: the event filter installed last is called first.
  view_.installEventFilter(this);
  view_.setFocus();
  view_.setCursor(Qt::CrossCursor);
  state_ = State::Waiting;
  emit noted(tr("Drag a box around parts; Shift adds, Ctrl adds or removes, Esc cancels"));
}

void BoxSelect::end() {
  band_->hide();
  view_.unsetCursor();
  state_ = state_ == State::Dragging ? State::Abandoned : State::Off;
}

bool BoxSelect::eventFilter(QObject* watched, QEvent* event) {
  if (watched != &view_ || state_ == State::Off) return QObject::eventFilter(watched, event);
  switch (event->type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonDblClick:
      return press(*static_cast<QMouseEvent*>(event));
    case QEvent::MouseMove:
      if (state_ == State::Dragging)
        band_->setGeometry(QRect(begin_, static_cast<QMouseEvent*>(event)->pos()).normalized());
      return state_ != State::Waiting;
    case QEvent::MouseButtonRelease:
      return release(*static_cast<QMouseEvent*>(event));
    case QEvent::ShortcutOverride:
      // Before other tools that Escape ends.
      if (static_cast<QKeyEvent*>(event)->key() != Qt::Key_Escape) return false;
      event->accept();
      return true;
    case QEvent::KeyPress:
      return static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape && cancel();
    default:
      return false;
  }
}

bool BoxSelect::press(const QMouseEvent& event) {
  const bool isOnlyOne = event.buttons() == event.button();
  // The release of other buttons was missed.
  if (state_ == State::Abandoned && isOnlyOne) state_ = State::Off;
  if (state_ == State::Off) return false;
  if (state_ == State::Dragging && !isOnlyOne) {
    cancel();
  } else if (state_ != State::Abandoned) {
    if (event.button() != Qt::LeftButton) return false;
    state_ = State::Dragging;
    begin_ = event.pos();
    band_->setGeometry(QRect(begin_, QSize()));
    band_->show();
  }
  return true;
}

bool BoxSelect::release(const QMouseEvent& event) {
  if (state_ == State::Waiting) return false;
  if (state_ == State::Abandoned) {
    if (event.buttons() == Qt::NoButton) state_ = State::Off;
    return true;
  }
  if (event.button() != Qt::LeftButton) return true;
  state_ = State::Waiting;
  action_->setChecked(false);
  const QRect box = QRect(begin_, event.pos()).normalized();
  const bool isClick = (event.pos() - begin_).manhattanLength() < QApplication::startDragDistance();
  isClick ? view_.pickAt(begin_, event.modifiers()) : take(box, event.modifiers());
  return true;
}

bool BoxSelect::cancel() {
  action_->setChecked(false);
  return true;
}

void BoxSelect::take(const QRect& box, Qt::KeyboardModifiers modifiers) {
  const std::vector<PartId> seen = view_.partsIn(box);
  const bool isToggled = modifiers.testFlag(Qt::ControlModifier);
  if (!isToggled && !modifiers.testFlag(Qt::ShiftModifier)) return selection_.set(seen);
  std::vector<PartId> next = selection_.parts();
  for (const PartId part : seen) {
    if (isToggled && selection_.contains(part)) {
      std::erase(next, part);
    } else {
      next.push_back(part);
    }
  }
  selection_.set(next, selection_.groups());
}

}  // namespace nearfit::ui
