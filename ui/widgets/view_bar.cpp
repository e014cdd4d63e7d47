#include "ui/widgets/view_bar.h"

#include <QCoreApplication>
#include <QEvent>
#include <algorithm>

namespace nearfit::ui {
namespace {

constexpr int kEdgeGap = 12, kBetween = 8;

}  // namespace

ViewBar::ViewBar(QWidget* view, const QString& name) : QFrame(view) {
  setObjectName(name);
  setStyleSheet(QStringLiteral("#%1 { background: palette(window); border: 1px solid palette(mid); "
                               "border-radius: 8px; }")
                    .arg(name));
  view->installEventFilter(this);
  hide();
}

bool ViewBar::eventFilter(QObject* watched, QEvent* event) {
  if (watched == parentWidget() && event->type() == QEvent::Resize) placeAll();
  return QFrame::eventFilter(watched, event);
}

void ViewBar::showEvent(QShowEvent* event) {
  QFrame::showEvent(event);
  place();
}

void ViewBar::hideEvent(QHideEvent* event) {
  QFrame::hideEvent(event);
  placeAll();
}

void ViewBar::place() {
  adjustSize();
  placeAll();
}

void ViewBar::placeAll() {
  const QWidget& view = *parentWidget();
  int bottom = view.height() - kEdgeGap;
  for (ViewBar* bar : view.findChildren<ViewBar*>(QString(), Qt::FindDirectChildrenOnly)) {
    if (bar->isHidden()) continue;
    bar->move(std::max(kEdgeGap, (view.width() - bar->width()) / 2), bottom - bar->height());
    bottom -= bar->height() + kBetween;
  }
  // For overlays that stay clear of the bars.
  QCoreApplication::postEvent(parentWidget(), new QEvent(QEvent::LayoutRequest));
}

}  // namespace nearfit::ui
