#include "ui/panels/pose/selected_pose.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/session/session.h"
#include "ui/model/hand_state.h"
#include "ui/model/move_guard.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/panels/pose/pose_panel.h"
#include "ui/view3d/viewport.h"

namespace nearfit::ui {
namespace {

const glm::dquat kNoTurn(1.0, 0.0, 0.0, 0.0);

/// Returns the part's name, the group's, or "Lid and 2 more".
QString headingOf(const Scene& scene, const Selection& selection) {
  if (!selection.current()) return {};
  const SceneNodes outer = outermost(scene, selection.nodes());
  if (outer.parts.empty() && outer.groups.size() == 1)
    return QString::fromStdString(scene.findGroup(outer.groups.front())->name);
  const QString name = QString::fromStdString(scene.find(*selection.current())->name);
  const auto others = static_cast<int>(selection.parts().size()) - 1;
  return others > 0 ? SelectedPose::tr("%1 and %n more", nullptr, others).arg(name) : name;
}

/// True if all selected nodes still exist. Other listeners may hear of a scene change
/// before the selection does.
bool isUpToDate(const Scene& scene, const SceneNodes& nodes) {
  return std::ranges::all_of(nodes.parts, [&](PartId part) { return scene.find(part) != nullptr; }) &&
         std::ranges::all_of(nodes.groups, [&](GroupId group) { return scene.findGroup(group) != nullptr; });
}

}  // namespace

SelectedPose::SelectedPose(const Context& context, PoseOf poseOf, PosePanel& panel)
    : QObject(&panel), context_(context), poseOf_(std::move(poseOf)), panel_(panel) {
  connectPanel();
  connect(&context.selection, &Selection::changed, this, &SelectedPose::refresh);
  connect(&context.guard, &MoveGuard::changed, this, &SelectedPose::refresh);
  connect(&context.hand, &HandState::snapshotShown, this, &SelectedPose::showHeldPose);
  connect(&context.view, &Viewport::posesChanged, this, [this] {
    const std::optional<PartId> id = context_.selection.current();
    if (id && context_.guard.isReplayed(*id)) refreshPose();
  });
  context.session.onChange([this] { refresh(); });
  refresh();
}

void SelectedPose::connectPanel() {
  connect(&panel_, &PosePanel::poseEdited, this, &SelectedPose::moveRequested);
  connect(&panel_, &PosePanel::densityEdited, this, &SelectedPose::setDensity);
  connect(&context_.work, &SceneWork::sceneNeeded, &panel_, &PosePanel::commit);
  connect(&context_.view, &Viewport::nudged, this,
          [this](int x, int y, int z) { emit stepRequested(panel_.step() * glm::dvec3(x, y, z), kNoTurn); });
  connect(&context_.view, &Viewport::turned, this, [this](int x, int y, int z) {
    emit stepRequested(glm::dvec3(0.0), glm::angleAxis(panel_.turnStep(), glm::dvec3(x, y, z)));
  });
}

const Part* SelectedPose::current() const {
  const std::optional<PartId> id = context_.selection.current();
  return id ? context_.session.scene().find(*id) : nullptr;
}

void SelectedPose::refresh() {
  const Scene& scene = context_.session.scene();
  const Selection& selection = context_.selection;
  if (!isUpToDate(scene, selection.nodes())) return;
  const Part* part = current();
  const QString heading = headingOf(scene, selection);
  QString help = heading;
  if (selection.parts().size() > 1)
    help += QChar('\n') + tr("The pose is that of %1").arg(QString::fromStdString(part->name));
  panel_.showPart(heading, context_.guard.refusalOf(selection.parts()), help);
  std::vector<const Part*> parts;
  for (const PartId each : selection.parts())
    parts.push_back(scene.find(each));
  panel_.showMass(parts, std::ranges::any_of(parts, [&](const Part* p) { return scene.isLocked(*p); }));
  const HandState& hand = context_.hand;
  if (hand.isHeldBy(Hand::Manual) && hand.holds(selection.current())) {
    panel_.showPose(hand.partPose(), hand.handPose());
  } else if (part != nullptr) {
    panel_.showPose(poseOf_(*part));
  }
}

void SelectedPose::refreshPose() {
  const Part* part = current();
  if (part != nullptr && !context_.hand.holds(part->id)) panel_.showPose(poseOf_(*part));
}

void SelectedPose::showHeldPose() {
  const HandState& hand = context_.hand;
  if (hand.holds(context_.selection.current())) panel_.showPose(hand.partPose(), hand.handPose());
}

void SelectedPose::setDensity(double density) {
  try {
    context_.session.setDensity(context_.selection.parts(), density);
  } catch (...) {
    emit failed(describe(tr("The density could not be changed."), std::current_exception()));
    refresh();
  }
}

}  // namespace nearfit::ui
