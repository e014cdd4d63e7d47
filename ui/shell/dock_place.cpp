#include "ui/shell/dock_place.h"

#include <QAction>
#include <QDockWidget>
#include <QLayout>
#include <QMainWindow>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>
#include <QVariant>
#include <algorithm>

namespace nearfit::ui {
namespace {

/// Share of the window's height that a dock gets by itself at most: the larger one is the view's.
constexpr double kMaxShareOfWindow = 0.45;
/// Property of a dock that has got its height: from then on it is the user's.
constexpr const char* kHasHeight = "hasHeight";

/// How much higher the pane has to be for all that its content asks for [pixels].
int missingHeight(const QScrollArea& pane) {
  const QWidget& content = *pane.widget();
  const int across =
      content.minimumSizeHint().width() > pane.width() ? pane.horizontalScrollBar()->sizeHint().height() : 0;
  return content.sizeHint().height() + across - pane.height();
}

void giveHeight(QDockWidget& dock) {
  auto* window = qobject_cast<QMainWindow*>(dock.parentWidget());
  const auto* pane = qobject_cast<const QScrollArea*>(dock.widget());
  if (window == nullptr || pane == nullptr || dock.isFloating() || dock.isHidden()) return;
  if (dock.property(kHasHeight).toBool()) return;
  dock.setProperty(kHasHeight, true);
  window->layout()->activate();
  const int most = static_cast<int>(kMaxShareOfWindow * window->height());
  int height = dock.height();
  // The height is that of the dock's place: the first time the bar of its tabs, if there is one, takes some of it.
  for (int again = 0; again < 2; ++again) {
    const int missing = missingHeight(*pane);
    if (missing <= 0 || height >= most) return;
    height = std::min(height + missing, most);
    window->resizeDocks({&dock}, {height}, Qt::Vertical);
    window->layout()->activate();
  }
}

/// True if the dock is open and another one lies before it.
bool isBehindTab(const QDockWidget& dock) {
  return dock.isVisible() && dock.visibleRegion().isEmpty();
}

}  // namespace

void bringToFront(QDockWidget& dock) {
  // Its tab comes with the layout.
  QTimer::singleShot(0, &dock, [&dock] {
    // A dock that was raised last may be behind another tab, and raising it again alone does nothing.
    dock.lower();
    dock.raise();
    giveHeight(dock);
  });
}

void showHideOrRaise(QDockWidget& dock) {
  isBehindTab(dock) ? bringToFront(dock) : dock.toggleViewAction()->trigger();
}

QAction* makePanelEntry(QDockWidget& dock) {
  const QAction* toggle = dock.toggleViewAction();
  auto* entry = new QAction(toggle->text(), &dock);
  entry->setObjectName(dock.objectName() + QStringLiteral("Entry"));
  entry->setCheckable(true);
  entry->setToolTip(QObject::tr("Show or hide this panel; one behind another tab comes to the front"));
  const auto follow = [entry, toggle] {
    entry->setText(toggle->text());
    entry->setChecked(toggle->isChecked());
  };
  follow();
  QObject::connect(toggle, &QAction::changed, entry, follow);
  QObject::connect(entry, &QAction::triggered, &dock, [&dock, follow] {
    showHideOrRaise(dock);
    // The choice has changed the mark, also where the dock stays open.
    follow();
  });
  return entry;
}

DockButton::DockButton(QDockWidget& dock, QWidget* parent) : QToolButton(parent), dock_(dock) {
  setObjectName(dock.objectName() + QStringLiteral("Button"));
  setDefaultAction(dock.toggleViewAction());
  setAutoRaise(true);
}

void DockButton::nextCheckState() {
  showHideOrRaise(dock_);
}

}  // namespace nearfit::ui
