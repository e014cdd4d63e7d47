// MainWindow: shows the selected parts and whether they may be moved.
#include <algorithm>

#include "ui/model/move_guard.h"
#include "ui/model/selection.h"
#include "ui/panels/pose/pose_panel.h"
#include "ui/shell/main_window.h"
#include "ui/shell/taking_away.h"
#include "ui/tools/placing/placing_tools.h"
#include "ui/view3d/viewport.h"

namespace nearfit::ui {
namespace {

/// Returns the part's name, the group's, or "Lid and 2 more".
QString headingOf(const Scene& scene, const Selection& selection) {
  if (!selection.current()) return {};
  const SceneNodes outer = outermost(scene, selection.nodes());
  if (outer.parts.empty() && outer.groups.size() == 1)
    return QString::fromStdString(scene.findGroup(outer.groups.front())->name);
  const QString name = QString::fromStdString(scene.find(*selection.current())->name);
  const auto others = static_cast<int>(selection.parts().size()) - 1;
  return others > 0 ? MainWindow::tr("%1 and %n more", nullptr, others).arg(name) : name;
}

}  // namespace

void MainWindow::connectMoveGuard() {
  connect(guard_, &MoveGuard::changed, this, &MainWindow::showSelection);
  connect(takingAway_, &TakingAway::replayingChanged, guard_, &MoveGuard::setReplaying);
  connect(viewport_, &Viewport::posesChanged, this, [this] {
    const std::optional<PartId> id = selected();
    if (id && guard_->isReplayed(*id)) posePanel_->showPose(poseOf(*session_.scene().find(*id)));
  });
}

void MainWindow::showSelection() {
  const std::optional<PartId> id = selected();
  const Scene& scene = session_.scene();
  const Part* part = id ? scene.find(*id) : nullptr;
  const std::vector<PartId>& selection = selection_->parts();
  const QString heading = headingOf(scene, *selection_);
  QString help = heading;
  if (selection.size() > 1)
    help += QChar('\n') + tr("The pose is that of %1").arg(QString::fromStdString(part->name));
  posePanel_->showPart(heading, guard_->refusalOf(selection), help);
  std::vector<const Part*> parts;
  for (const PartId each : selection)
    parts.push_back(scene.find(each));
  posePanel_->showMass(parts, std::ranges::any_of(parts, [&](const Part* p) { return scene.isLocked(*p); }));
  if (holds(id) && servo_.hand == Hand::Manual) {
    posePanel_->showPose(poseInHand_, handPose_);
  } else if (part != nullptr) {
    posePanel_->showPose(poseOf(*part));
  }
  updateActions();
}

std::optional<PartId> MainWindow::selected() const {
  return selection_->current();
}

bool MainWindow::holds(std::optional<PartId> part) const {
  return servo_.isRunning && part && session_.scene().movingPart() == part;
}

RigidTransform MainWindow::poseOf(const Part& part) const {
  if (const std::optional<RigidTransform> dragged = placing_->draggedPose(part.id)) return *dragged;
  if (guard_->isReplayed(part.id)) return viewport_->shownPose(part.id).value_or(part.worldFromPart);
  return holds(part.id) ? poseInHand_ : part.worldFromPart;
}

}  // namespace nearfit::ui
