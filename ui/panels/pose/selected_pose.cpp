#include "ui/panels/pose/selected_pose.h"

#include <algorithm>
#include <vector>

#include "core/placing/pivot.h"
#include "core/session/session.h"
#include "ui/model/hand_state.h"
#include "ui/model/joint_names.h"
#include "ui/model/move_guard.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/panels/pose/pose_panel.h"
#include "ui/view3d/viewport.h"

namespace nearfit::ui {
namespace {

const glm::dquat kNoTurn(1.0, 0.0, 0.0, 0.0);

/// Returns the part's name, the group's, or "Lid and 2 more"; without a selection the name of what is in hand, if
/// `part` is.
QString headingOf(const Scene& scene, const Selection& selection, const Part* part) {
  if (!selection.current() && part == nullptr) return {};
  if (!selection.current())
    return QString::fromStdString(scene.movingGroup() ? scene.findGroup(*scene.movingGroup())->name
                                                      : part->name);
  const SceneNodes outer = outermost(scene, selection.nodes());
  if (outer.parts.empty() && outer.groups.size() == 1)
    return QString::fromStdString(scene.findGroup(outer.groups.front())->name);
  const QString name = QString::fromStdString(scene.find(*selection.current())->name);
  const auto others = static_cast<int>(selection.parts().size()) - 1;
  return others > 0 ? SelectedPose::tr("%1 and %n more", nullptr, others).arg(name) : name;
}

}  // namespace

SelectedPose::SelectedPose(const Context& context, PosePanel& panel)
    : QObject(&panel), context_(context), panel_(panel) {
  connectPanel();
  connect(&context.selection, &Selection::changed, this, &SelectedPose::refresh);
  connect(&context.guard, &MoveGuard::changed, this, &SelectedPose::refresh);
  connect(&context.hand, &HandState::changed, this, &SelectedPose::refresh);
  connect(&context.hand, &HandState::snapshotShown, this, &SelectedPose::showHeldPose);
  connect(&context.poses, &ShownPoses::changed, this, [this](const std::vector<PartId>& parts) {
    const Part* part = current();
    if (part == nullptr || context_.hand.part() == part->id || std::ranges::count(parts, part->id) == 0)
      return;
    panel_.showPose(context_.poses.poseOf(*part));
  });
  changes_ = context.session.onChange(SceneEvents::Stage::Panels, [this] { refresh(); });
  refresh();
}

void SelectedPose::connectPanel() {
  panel_.setPivot([this] { return pivotInCurrent(); });
  connect(&panel_, &PosePanel::poseEdited, this, &SelectedPose::moveRequested);
  connect(&panel_, &PosePanel::densityEdited, this, &SelectedPose::setDensity);
  connect(&panel_, &PosePanel::jointRemovalRequested, this, &SelectedPose::removeJoints);
  connect(&context_.work, &SceneWork::sceneNeeded, &panel_, &PosePanel::commit);
  connect(&context_.view, &Viewport::nudged, this,
          [this](int x, int y, int z) { emit stepRequested(panel_.step() * glm::dvec3(x, y, z), kNoTurn); });
  connect(&context_.view, &Viewport::turned, this, [this](int x, int y, int z) {
    emit stepRequested(glm::dvec3(0.0), glm::angleAxis(panel_.turnStep(), glm::dvec3(x, y, z)));
  });
}

std::vector<PartId> SelectedPose::subjects() const {
  const std::optional<PartId> held = context_.hand.part();
  if (context_.selection.current() || !held) return context_.selection.parts();
  std::vector<PartId> parts = context_.session.scene().movingParts();
  // The pose of a group is that of the part that leads.
  std::erase(parts, *held);
  parts.push_back(*held);
  return parts;
}

const Part* SelectedPose::current() const {
  const std::vector<PartId> parts = subjects();
  return parts.empty() ? nullptr : context_.session.scene().find(parts.back());
}

glm::dvec3 SelectedPose::pivotInCurrent() const {
  const Part* part = current();
  std::vector<PlacedPart> placed;
  for (const PartId id : subjects()) {
    const Part* each = context_.session.scene().find(id);
    if (each != nullptr && each->geometry != nullptr) placed.push_back({each, context_.poses.poseOf(*each)});
  }
  if (part == nullptr || placed.empty()) return glm::dvec3(0.0);
  const glm::dvec3 pivot = sharedPivot(placed).value_or(centreOfMass(placed));
  return context_.poses.poseOf(*part).inverse().applyToPoint(pivot);
}

void SelectedPose::refresh() {
  const Scene& scene = context_.session.scene();
  const Selection& selection = context_.selection;
  const Part* part = current();
  const QString heading = headingOf(scene, selection, part);
  QString help = heading;
  if (subjects().size() > 1)
    help += QChar('\n') + tr("The pose shown is that of %1").arg(QString::fromStdString(part->name));
  panel_.showPart(heading, context_.guard.refusalOf(subjects()), help);
  std::vector<const Part*> parts;
  for (const PartId each : subjects())
    parts.push_back(scene.find(each));
  panel_.showMass(parts, std::ranges::any_of(parts, [&](const Part* p) { return scene.isLocked(*p); }));
  showJoints();
  const HandState& hand = context_.hand;
  if (part != nullptr && hand.isHeldBy(Hand::Manual) && hand.part() == part->id) {
    panel_.showPose(hand.partPose(), hand.handPose());
  } else if (part != nullptr) {
    panel_.showPose(context_.poses.poseOf(*part));
  }
}

void SelectedPose::showHeldPose() {
  const HandState& hand = context_.hand;
  const Part* part = current();
  if (part != nullptr && hand.part() == part->id) panel_.showPose(hand.partPose(), hand.handPose());
}

void SelectedPose::setDensity(double density) {
  try {
    context_.session.setDensity(subjects(), density);
  } catch (...) {
    emit failed(describe(tr("The density could not be changed."), std::current_exception()));
    refresh();
  }
}

/// Shows the joints of the current part, whose pose is shown too.
void SelectedPose::showJoints() {
  const Scene& scene = context_.session.scene();
  const Part* part = current();
  const std::vector<Joint> joints = part != nullptr ? jointsOfParts(scene, {part->id}) : std::vector<Joint>{};
  if (joints.empty()) return panel_.showJoints({});
  const auto others = static_cast<int>(joints.size()) - 1;
  const QString first = jointTexts(scene, {joints.front()});
  panel_.showJoints(others > 0 ? tr("%1 and %n more", nullptr, others).arg(first) : first,
                    jointTexts(scene, joints), !scene.isLocked(*part),
                    startOfJointText(scene, joints.front()));
}

void SelectedPose::removeJoints() {
  const Part* part = current();
  if (part == nullptr) return;
  std::vector<JointId> ids;
  for (const Joint& joint : jointsOfParts(context_.session.scene(), {part->id}))
    ids.push_back(joint.id);
  try {
    context_.session.removeJoints(ids);
  } catch (...) {
    emit failed(describe(tr("The joint could not be removed."), std::current_exception()));
    refresh();
  }
}

}  // namespace nearfit::ui
