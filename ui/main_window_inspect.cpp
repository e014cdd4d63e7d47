// The tools that look at the scene and change nothing of it.
#include <QAction>
#include <QMenu>
#include <QToolBar>

#include "ui/actions.h"
#include "ui/main_window.h"
#include "ui/measure/measure_tool.h"
#include "ui/section/section_tool.h"
#include "ui/unit_menu.h"
#include "ui/viewport.h"

namespace nearfit::ui {

void MainWindow::setUpInspecting() {
  auto* measure = new MeasureTool(session_, *viewport_, this);
  connect(findChild<UnitMenu*>(QStringLiteral("unitMenu")), &UnitMenu::unitChanged, measure,
          &MeasureTool::refresh);
  const auto* section = new SectionTool(session_, *viewport_, this);
  const QList<QAction*> tools{measure->action(), section->action()};
  actions_->viewMenu->insertActions(actions_->panelsMenu->menuAction(), tools);
  actions_->viewMenu->insertSeparator(actions_->panelsMenu->menuAction());
  auto* bar = findChild<QToolBar*>(QStringLiteral("placingBar"));
  bar->addSeparator();
  bar->addActions(tools);
}

}  // namespace nearfit::ui
