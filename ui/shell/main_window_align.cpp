// MainWindow: sets up and updates the tools that align parts and move them to contact.
#include <QAction>
#include <QMenu>
#include <QToolBar>

#include "ui/files/document.h"
#include "ui/model/move_guard.h"
#include "ui/model/selection.h"
#include "ui/shell/actions.h"
#include "ui/shell/main_window.h"
#include "ui/tools/placing/align_tool.h"
#include "ui/tools/placing/drop_tool.h"
#include "ui/tools/placing/placing_tools.h"
#include "ui/view3d/viewport.h"

namespace nearfit::ui {

void MainWindow::setUpAligning() {
  align_ = new AlignTool(session_, *selection_, *viewport_, *guard_, this);
  const auto prepare = [this](std::function<void(bool)> done) {
    document_->prepareHierarchies(std::move(done));
  };
  drop_ = new DropTool(session_, *selection_, *viewport_, prepare, this);
  actions_->placeMenu->addSeparator();
  actions_->placeMenu->addAction(align_->action());
  drop_->addTo(*actions_->placeMenu);
  findChild<QToolBar*>(QStringLiteral("placingBar"))->addAction(align_->action());
  connect(align_, &AlignTool::moveWanted, placing_,
          [this](const std::vector<PartId>& parts, PartId lead, const RigidTransform& worldFromLead) {
            placing_->bring(parts, lead, worldFromLead, "Align");
          });
  connect(align_, &AlignTool::activeChanged, placing_, &PlacingTools::setAside);
  connect(align_, &AlignTool::noted, this, &MainWindow::showNote);
  connect(drop_, &DropTool::failed, this, &MainWindow::showFailure);
  connect(drop_, &DropTool::noted, this, &MainWindow::showNote);
}

void MainWindow::updateAligning() {
  // While the servo holds a part, the hand moves it.
  const bool canMove = !servo_.isTaken() && session_.scene().parts().size() > 1;
  const bool isFree = canMove && !document_->isBusy();
  align_->setAvailable(canMove, document_->isBusy());
  drop_->setAvailable(isFree && !selection_->isEmpty() && guard_->refusalOf(selection_->parts()).isEmpty());
}

}  // namespace nearfit::ui
