#include "ui/widgets/view_bar.h"

#include <QCoreApplication>
#include <QKeyEvent>
#include <QVBoxLayout>
#include <cassert>

namespace nearfit::ui {
namespace {

/// Height that bars leave of a view where there is no room for both; software OpenGL needs some [pixels].
constexpr int kLeastOfView = 60;

}  // namespace

ViewArea::ViewArea(QWidget* view, QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("viewArea"));
  // The window does not grow for a bar.
  setMinimumSize(view->minimumSize());
  view->setMinimumHeight(kLeastOfView);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins({});
  column->setSpacing(0);
  column->addWidget(view, 1);
}

void ViewArea::add(QWidget* bar) {
  constexpr int kBelowView = 1;
  static_cast<QVBoxLayout*>(layout())->insertWidget(kBelowView, bar);
}

ViewBar::ViewBar(QWidget* view, const QString& name) : QFrame(view->parentWidget()), view_(view) {
  setObjectName(name);
  setStyleSheet(
      QStringLiteral("#%1 { background: palette(window); border-top: 1px solid palette(mid); }").arg(name));
  // A long prompt does not widen the window.
  setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);
  hide();
  auto* area = qobject_cast<ViewArea*>(parentWidget());
  assert(area != nullptr);
  area->add(this);
}

void ViewBar::keyPressEvent(QKeyEvent* event) {
  QCoreApplication::sendEvent(view_, event);
  // The view passed on what it did not want.
  event->accept();
}

void ViewBar::hideEvent(QHideEvent* event) {
  QFrame::hideEvent(event);
  // A bar that goes with its window, which is minimised or closed, keeps its place.
  if (!isHidden()) return;
  // Qt would give the keys to whatever comes next by Tab: a button of the status bar.
  const QWidget* focused = window()->focusWidget();
  if (focused != nullptr && isAncestorOf(focused)) view_->setFocus();
}

void ViewBar::place() {
  if (!isVisible()) return;
  layout()->activate();
  parentWidget()->layout()->activate();
}

}  // namespace nearfit::ui
