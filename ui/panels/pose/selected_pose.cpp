#include "ui/panels/pose/selected_pose.h"

#include <algorithm>
#include <vector>

#include "core/scene/moving_body.h"
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

/// Returns the part's name, the group's, or "Lid and 2 more"; empty if there is no part.
QString headingOf(const Scene& scene, const Selection& selection, const PoseSubject& subject) {
  if (!subject.lead()) return {};
  if (subject.isGroupInHand) return QString::fromStdString(scene.findGroup(*scene.movingGroup())->name);
  const SceneNodes outer = outermost(scene, selection.nodes());
  if (outer.parts.empty() && outer.groups.size() == 1)
    return QString::fromStdString(scene.findGroup(outer.groups.front())->name);
  const QString name = QString::fromStdString(scene.get(*subject.lead()).name);
  const auto others = static_cast<int>(subject.parts.size()) - 1;
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
    const Part* part = lead(subject());
    if (part == nullptr || context_.hand.part() == part->id || std::ranges::count(parts, part->id) == 0)
      return;
    panel_.showPose(context_.poses.poseOf(*part));
    showCentre(*part);
  });
  changes_ = context.session.onChange(SceneEvents::Stage::Panels, [this] { refresh(); });
  refresh();
}

void SelectedPose::connectPanel() {
  panel_.setPivot([this] { return pivotInLead(context_.session.scene(), subject(), context_.poses); });
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

PoseSubject SelectedPose::subject() const {
  return poseSubjectOf(context_.session.scene(), context_.selection, context_.hand);
}

const Part* SelectedPose::lead(const PoseSubject& subject) const {
  return subject.lead() ? context_.session.scene().find(*subject.lead()) : nullptr;
}

void SelectedPose::refresh() {
  const Scene& scene = context_.session.scene();
  const PoseSubject subject = this->subject();
  const Part* part = lead(subject);
  const QString heading = headingOf(scene, context_.selection, subject);
  QString help = heading;
  if (subject.parts.size() > 1) {
    help += QChar('\n') + (subject.isGroupInHand
                               ? tr("The pose shown is that of %1, which leads the group in hand")
                               : tr("The pose shown is that of %1"))
                              .arg(QString::fromStdString(part->name));
  }
  panel_.showPart(heading, context_.guard.refusalOf(subject), help);
  showMass(subject);
  showJoints(subject);
  const HandState& hand = context_.hand;
  if (part != nullptr && hand.isHeldBy(Hand::Manual) && hand.part() == part->id) {
    panel_.showPose(hand.partPose(), hand.handPose());
  } else if (part != nullptr) {
    panel_.showPose(context_.poses.poseOf(*part));
  }
  if (part != nullptr) showCentre(*part);
}

void SelectedPose::showHeldPose() {
  const HandState& hand = context_.hand;
  const Part* part = lead(subject());
  if (part == nullptr || hand.part() != part->id) return;
  panel_.showPose(hand.partPose(), hand.handPose());
  showCentre(*part);
}

void SelectedPose::showMass(const PoseSubject& subject) {
  const Scene& scene = context_.session.scene();
  std::vector<const Part*> parts;
  for (const PartId each : subject.parts)
    parts.push_back(scene.find(each));
  const bool isLocked = std::ranges::any_of(parts, [&](const Part* p) { return scene.isLocked(*p); });
  centreInLead_.reset();
  panel_.showCentre({});
  if (!subject.isGroupInHand) return panel_.showMass(parts, isLocked);
  const MovingMass mass = massOfMoving(scene);
  panel_.showMass(parts, isLocked, mass.mass);
  centreInLead_ = mass.properties.centre;
}

void SelectedPose::showCentre(const Part& lead) {
  if (!centreInLead_) return;
  const bool isHeld = context_.hand.part() == lead.id;
  const RigidTransform pose = isHeld ? context_.hand.partPose() : context_.poses.poseOf(lead);
  panel_.showCentre(pose.applyToPoint(*centreInLead_));
}

void SelectedPose::setDensity(double density) {
  try {
    context_.session.setDensity(subject().parts, density);
  } catch (...) {
    emit failed(describe(tr("The density could not be changed."), std::current_exception()));
    refresh();
  }
}

std::vector<Joint> SelectedPose::shownJoints(const PoseSubject& subject) const {
  const Scene& scene = context_.session.scene();
  if (!subject.lead()) return {};
  if (!subject.isGroupInHand) return jointsOfParts(scene, {*subject.lead()});
  std::vector<Joint> joints = jointsOfParts(scene, subject.parts);
  // These move along and hold nothing.
  std::erase_if(joints, [&scene](const Joint& joint) { return joint.base && scene.isMoving(*joint.base); });
  return joints;
}

void SelectedPose::showJoints(const PoseSubject& subject) {
  const Scene& scene = context_.session.scene();
  const std::vector<Joint> joints = shownJoints(subject);
  if (joints.empty()) return panel_.showJoints({});
  const auto others = static_cast<int>(joints.size()) - 1;
  const QString first = jointTexts(scene, {joints.front()});
  const bool isLocked = std::ranges::any_of(
      joints, [&scene](const Joint& joint) { return scene.isLocked(scene.get(joint.part)); });
  panel_.showJoints(others > 0 ? tr("%1 and %n more", nullptr, others).arg(first) : first,
                    jointTexts(scene, joints), !isLocked, startOfJointText(scene, joints.front()));
}

void SelectedPose::removeJoints() {
  std::vector<JointId> ids;
  for (const Joint& joint : shownJoints(subject()))
    ids.push_back(joint.id);
  if (ids.empty()) return;
  try {
    context_.session.removeJoints(ids);
  } catch (...) {
    emit failed(describe(tr("The joint could not be removed."), std::current_exception()));
    refresh();
  }
}

}  // namespace nearfit::ui
