#include "ui/tools/selecting/view_menu.h"

#include <QApplication>
#include <QContextMenuEvent>
#include <QMenu>
#include <QMouseEvent>
#include <QTimer>
#include <utility>

#include "ui/model/selection.h"
#include "ui/view3d/viewport.h"

namespace nearfit::ui {

ViewMenu::ViewMenu(Selection& selection, Viewport& view, QList<QAction*> ofParts, QList<QAction*> ofNothing,
                   QObject* parent)
    : QObject(parent),
      selection_(selection),
      view_(view),
      ofParts_(std::move(ofParts)),
      ofNothing_(std::move(ofNothing)) {
  view.installEventFilter(this);
}

bool ViewMenu::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonDblClick:
      press(*static_cast<QMouseEvent*>(event));
      break;
    case QEvent::MouseMove:
      if (pressedAt_ && (static_cast<QMouseEvent*>(event)->pos() - *pressedAt_).manhattanLength() >=
                            QApplication::startDragDistance())
        pressedAt_.reset();
      break;
    case QEvent::MouseButtonRelease:
      release(*static_cast<QMouseEvent*>(event));
      break;
    case QEvent::ContextMenu:
      if (static_cast<QContextMenuEvent*>(event)->reason() != QContextMenuEvent::Keyboard) break;
      popUp(selection_.isEmpty() ? ofNothing_ : ofParts_, view_.rect().center());
      return true;
    default:
      break;
  }
  // The view needs these events too.
  return QObject::eventFilter(watched, event);
}

void ViewMenu::press(const QMouseEvent& event) {
  const bool isAlone = event.buttons() == Qt::RightButton && event.modifiers() == Qt::NoModifier;
  pressedAt_ = isAlone ? std::optional(event.pos()) : std::nullopt;
}

void ViewMenu::release(const QMouseEvent& event) {
  if (event.button() != Qt::RightButton || !std::exchange(pressedAt_, std::nullopt)) return;
  // Deferred: the view must handle the release first.
  QTimer::singleShot(0, this, [this, at = event.pos()] { openAt(at); });
}

void ViewMenu::openAt(const QPoint& position) {
  const std::optional<PickedPoint> picked = view_.pointAt(position);
  if (!picked) return popUp(ofNothing_, position);
  if (!selection_.contains(picked->part)) selection_.select(picked->part);
  popUp(ofParts_, position);
}

void ViewMenu::popUp(const QList<QAction*>& actions, const QPoint& position) {
  auto* menu = new QMenu(&view_);
  menu->setObjectName(QStringLiteral("viewMenu"));
  menu->setAttribute(Qt::WA_DeleteOnClose);
  menu->addActions(actions);
  menu->setToolTipsVisible(true);
  menu->popup(view_.mapToGlobal(position));
}

}  // namespace nearfit::ui
