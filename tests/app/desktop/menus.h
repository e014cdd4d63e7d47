#pragma once

#include <QAction>
#include <QApplication>
#include <QDeadlineTimer>
#include <QDockWidget>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QToolButton>
#include <QtTest>
#include <ranges>

#include "core/base/error.h"
#include "tests/support/qt/qt_patience.h"

/// Commands as a user gives them: by clicks through the menus down to an entry, or on a button of a toolbar.
namespace nearfit::test {

/// The menus that lead to an entry, from the outermost; none where no menu does.
inline QList<QMenu*> menusTo(const QList<QAction*>& entries, QAction* wanted) {
  for (QAction* entry : entries) {
    QMenu* menu = entry->menu();
    if (menu == nullptr) continue;
    if (menu->actions().contains(wanted)) return {menu};
    const QList<QMenu*> within = menusTo(menu->actions(), wanted);
    if (!within.isEmpty()) return QList<QMenu*>{menu} + within;
  }
  return {};
}

inline void clickEntry(QMenu& menu, QAction* entry) {
  QTest::mouseClick(&menu, Qt::LeftButton, {}, menu.actionGeometry(entry).center());
}

/// How long a menu may take before it is opened again.
inline constexpr int kUntilTheNextTryMs = 1500;

/// Tries to open a menu until it is there; false when it does not come. Without a window manager the focus may arrive
/// late, of a dialog that has gone or of the window itself, and closes what has just opened.
/// @param open  Tries once; true when the menu is there.
template <class Open>
bool openPatiently(const Open& open) {
  const QDeadlineTimer end(kQtPatienceMs);
  bool isOpen = open();
  while (!isOpen && !end.hasExpired())
    isOpen = open();
  return isOpen;
}

/// Opens menus one out of the other, the first from the window's bar; false when one of them does not come.
inline bool openMenusOnce(QMainWindow& window, const QList<QMenu*>& path) {
  QMenuBar* bar = window.menuBar();
  QTest::mouseClick(bar, Qt::LeftButton, {}, bar->actionGeometry(path.first()->menuAction()).center());
  for (int i = 0; i < path.size(); ++i) {
    const auto isOpen = [&] { return path[i]->isVisible(); };
    bool isThere = QTest::qWaitFor(isOpen, kUntilTheNextTryMs);
    if (!isThere && i > 0 && path[i - 1]->isVisible()) {
      // The entry that was chosen last is the active one already, and a click on it opens nothing at once.
      clickEntry(*path[i - 1], path[i]->menuAction());
      isThere = QTest::qWaitFor(isOpen, kUntilTheNextTryMs);
    }
    if (!isThere) return false;
    if (i + 1 < path.size()) clickEntry(*path[i], path[i + 1]->menuAction());
  }
  return true;
}

/// The same, and again from the bar where it fails.
inline void openMenus(QMainWindow& window, const QList<QMenu*>& path) {
  const bool isOpen = openPatiently([&] {
    if (openMenusOnce(window, path)) return true;
    for (QMenu* menu : std::views::reverse(path))
      menu->hide();
    QApplication::setActiveWindow(&window);
    return false;
  });
  if (!isOpen) throw Error("menus", path.last()->title().toStdString() + " does not open");
}

/// @throws Error  What a user could not choose either: it is disabled, hidden or nowhere to be seen.
inline void chooseCommand(QMainWindow& window, QAction* action) {
  const std::string name = action->objectName().toStdString();
  const QList<QMenu*> path = menusTo(window.menuBar()->actions(), action);
  if (!path.isEmpty()) {
    openMenus(window, path);
    // What can be done may be known only as the menu opens.
    if (!action->isEnabled() || !action->isVisible()) throw Error("menus", name + " cannot be chosen now");
    clickEntry(*path.last(), action);
    return;
  }
  for (auto* button : window.findChildren<QToolButton*>()) {
    if (button->defaultAction() != action || !button->isVisible()) continue;
    if (!button->isEnabled()) throw Error("menus", name + " cannot be pressed now");
    return QTest::mouseClick(button, Qt::LeftButton);
  }
  throw Error("menus", name + " is in no menu and on no toolbar");
}

/// The entry of a panel in the menu *Panels*.
inline QAction* panelEntry(const QDockWidget* dock) {
  return dock->findChild<QAction*>(dock->objectName() + QStringLiteral("Entry"), Qt::FindDirectChildrenOnly);
}

}  // namespace nearfit::test
