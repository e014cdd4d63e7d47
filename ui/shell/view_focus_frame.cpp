#include "ui/shell/view_focus_frame.h"

#include <QEvent>
#include <QFrame>
#include <QWidget>

#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr int kEdgeWidth = 2;  ///< [pixels]

}  // namespace

ViewFocusFrame::ViewFocusFrame(QWidget* view) : QObject(view), view_(view) {
  for (QWidget*& edge : edges_) {
    edge = new QFrame(view);
    edge->setObjectName(QStringLiteral("viewFocusEdge"));
    edge->setAttribute(Qt::WA_TransparentForMouseEvents);
    edge->setStyleSheet(QStringLiteral("background: %1").arg(colours::kAccent.name()));
  }
  view->installEventFilter(this);
  place();
  setShown(view->hasFocus());
}

bool ViewFocusFrame::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::Resize:
      place();
      break;
    case QEvent::FocusIn:
      setShown(true);
      break;
    case QEvent::FocusOut:
      setShown(false);
      break;
    default:
      break;
  }
  return QObject::eventFilter(watched, event);
}

void ViewFocusFrame::setShown(bool isShown) {
  for (QWidget* edge : edges_) {
    edge->setVisible(isShown);
    if (isShown) edge->raise();
  }
}

void ViewFocusFrame::place() {
  const int width = view_->width(), height = view_->height();
  edges_[0]->setGeometry(0, 0, width, kEdgeWidth);
  edges_[1]->setGeometry(0, height - kEdgeWidth, width, kEdgeWidth);
  edges_[2]->setGeometry(0, 0, kEdgeWidth, height);
  edges_[3]->setGeometry(width - kEdgeWidth, 0, kEdgeWidth, height);
}

}  // namespace nearfit::ui
