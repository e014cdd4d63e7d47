// MainWindow: shows the selected parts and whether they may be moved.
#include <algorithm>

#include "ui/model/move_guard.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/pose/pose_panel.h"
#include "ui/shell/main_window.h"
#include "ui/shell/taking_away.h"

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
  connect(poses_, &ShownPoses::changed, this, [this](const std::vector<PartId>& parts) {
    const std::optional<PartId> id = selected();
    if (!id || holds(id) || std::ranges::count(parts, *id) == 0) return;
    posePanel_->showPose(poses_->poseOf(*session_.scene().find(*id)));
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
    help += QChar('\n') + tr("The pose shown is that of %1").arg(QString::fromStdString(part->name));
  posePanel_->showPart(heading, guard_->refusalOf(selection), help);
  std::vector<const Part*> parts;
  for (const PartId each : selection)
    parts.push_back(scene.find(each));
  posePanel_->showMass(parts, std::ranges::any_of(parts, [&](const Part* p) { return scene.isLocked(*p); }));
  if (holds(id) && servo_.hand == Hand::Manual) {
    posePanel_->showPose(poseOfMoving(), handPose_);
  } else if (part != nullptr) {
    posePanel_->showPose(poses_->poseOf(*part));
  }
  updateActions();
}

std::optional<PartId> MainWindow::selected() const {
  return selection_->current();
}

bool MainWindow::holds(std::optional<PartId> part) const {
  return servo_.isRunning && part && session_.scene().movingPart() == part;
}

RigidTransform MainWindow::poseOfMoving() const {
  const Part* part = session_.scene().find(session_.scene().movingPart().value_or(PartId{}));
  return part != nullptr ? poses_->poseOf(*part) : RigidTransform{};
}

}  // namespace nearfit::ui
