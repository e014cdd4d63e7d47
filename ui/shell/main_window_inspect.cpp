// MainWindow: sets up the tools that inspect the scene without changing it.
#include <QAction>
#include <QMenu>
#include <QToolBar>

#include "ui/panels/history/history_panel.h"
#include "ui/panels/view/minima_menu.h"
#include "ui/shell/actions.h"
#include "ui/shell/main_window.h"
#include "ui/shell/unit_menu.h"
#include "ui/tools/measure/measure_tool.h"
#include "ui/tools/section/section_tool.h"
#include "ui/tools/selecting/box_select.h"
#include "ui/view3d/viewport.h"

namespace nearfit::ui {

void MainWindow::setUpInspecting() {
  auto* measure = new MeasureTool(session_, *viewport_, this);
  const auto* units = findChild<UnitMenu*>(QStringLiteral("unitMenu"));
  connect(units, &UnitMenu::unitChanged, measure, &MeasureTool::refresh);
  auto* history = findChild<HistoryPanel*>(QStringLiteral("historyPanel"));
  connect(units, &UnitMenu::unitChanged, history, &HistoryPanel::refresh);
  const auto* drawn = findChild<MinimaMenu*>();
  viewport_->setMinimaChoice(drawn->choice());
  connect(drawn, &MinimaMenu::choiceChanged, viewport_, &Viewport::setMinimaChoice);
  const auto* section = new SectionTool(session_, *viewport_, this);
  const auto* box = new BoxSelect(*selection_, *viewport_, this);
  connect(box, &BoxSelect::noted, this, &MainWindow::showNote);
  actions_->editMenu->insertAction(actions_->selectNone, box->action());
  const QList<QAction*> tools{measure->action(), section->action()};
  actions_->viewMenu->insertActions(actions_->panelsMenu->menuAction(), tools);
  actions_->viewMenu->insertSeparator(actions_->panelsMenu->menuAction());
  auto* bar = findChild<QToolBar*>(QStringLiteral("placingBar"));
  bar->addSeparator();
  bar->addActions(tools);
  bar->insertAction(bar->actions().constFirst(), box->action());
  bar->insertSeparator(bar->actions().at(1));
}

}  // namespace nearfit::ui
