#include "ui/tools/placing/hand_control.h"

#include <QAction>
#include <optional>
#include <vector>

#include "core/haptics/workspace_mapper.h"
#include "core/placing/joint_set.h"
#include "core/scene/moving_body.h"
#include "core/session/session.h"
#include "ui/model/hand_state.h"
#include "ui/model/joint_names.h"
#include "ui/model/move_guard.h"
#include "ui/model/pose_subject.h"
#include "ui/model/selection.h"
#include "ui/tools/placing/placing_tools.h"
#include "ui/view3d/hand_drag.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/make_action.h"

namespace nearfit::ui {
namespace {

/// Returns the pose shifted, and turned about `centre`, in the world.
/// @param centre  In the part's frame [m].
RigidTransform stepped(const RigidTransform& worldFromPart, const glm::dvec3& shift, const glm::dquat& turn,
                       const glm::dvec3& centre) {
  const glm::dquat rotation =
      RigidTransform{turn * worldFromPart.rotation, glm::dvec3(0.0)}.normalized().rotation;
  return {rotation, worldFromPart.applyToPoint(centre) + shift - rotation * centre};
}

}  // namespace

HandControl::HandControl(const Context& context, QObject* parent)
    : QObject(parent),
      context_(context),
      letGo_(makeAction(this, "letGo", tr("Return &hand to part"), QStringLiteral("hand-off"), Qt::Key_F7,
                        tr("Move the manual hand back to the part, so that it no longer presses"))) {
  // It must work from the feel settings too, which stay open beside the window.
  letGo_->setShortcutContext(Qt::ApplicationShortcut);
  letGo_->setEnabled(false);
  connect(letGo_, &QAction::triggered, this, &HandControl::letGo);
  connect(&context.placing, &PlacingTools::handWanted, this, &HandControl::moveHand);
  connect(&context.view.handDrag(), &HandDrag::dragged, this, &HandControl::stepHand);
  connectHand();
}

void HandControl::connectHand() {
  connect(&context_.hand, &HandState::changed, this, [this] {
    letGo_->setEnabled(context_.hand.isHeldBy(Hand::Manual));
    if (!context_.hand.part()) context_.view.handDrag().setPoint(std::nullopt);
    showHeld();
  });
  connect(&context_.hand, &HandState::snapshotShown, this, [this](const ServoSnapshot& snapshot) {
    const HandState& hand = context_.hand;
    const glm::dvec3 centreInPart = snapshot.proxy.inverse().applyToPoint(snapshot.centre);
    context_.view.handDrag().setPoint(hand.isHeldBy(Hand::Manual)
                                          ? std::optional(hand.handPose().applyToPoint(centreInPart))
                                          : std::nullopt);
    showHeld();
  });
}

void HandControl::showHeld() {
  const HandState& hand = context_.hand;
  const std::optional<PartId> part = hand.part();
  if (!part) return context_.placing.setHeld({});
  context_.placing.setHeld(HeldPart{*part, hand.handPose(), hand.isHeldBy(Hand::Manual)});
}

void HandControl::place(const RigidTransform& worldFromPart) {
  const Scene& scene = context_.session.scene();
  const PoseSubject subject = poseSubjectOf(scene, context_.selection, context_.hand);
  const std::optional<PartId> lead = subject.lead();
  if (!lead) return;
  const QString refusal = context_.guard.refusalOf(subject);
  if (!refusal.isEmpty()) return emit noted(refusal);
  if (!context_.hand.holds(lead)) return context_.placing.bring(subject.parts, *lead, worldFromPart, "Move");
  const JointSet joints = jointsOfMoving(scene);
  const JointResidual off = joints.residual(worldFromPart);
  const bool isOff = off.distance > JointSet::kMaxMisfit || off.angle > JointSet::kMaxMisfitAngle;
  if (isOff && !joints.isContradictory()) emit noted(heldText(scene, subject.parts));
  moveHand(worldFromPart);
}

void HandControl::step(const glm::dvec3& shift, const glm::dquat& turn) {
  if (context_.hand.isHeldBy(Hand::Manual)) return stepHand(shift, turn);
  context_.placing.commit();
  if (!context_.selection.current()) return;
  const Scene& scene = context_.session.scene();
  const PoseSubject subject = poseSubjectOf(scene, context_.selection, context_.hand);
  const Part* part = scene.find(*subject.lead());
  if (part == nullptr) return;
  const glm::dvec3 pivot = subject.isGroupInHand ? pivotInLead(scene, subject, context_.view.poses())
                                                 : part->pivot.value_or(part->geometry->mass.centre);
  place(stepped(part->worldFromPart, shift, turn, pivot));
}

void HandControl::stepHand(const glm::dvec3& shift, const glm::dquat& turn) {
  const HandState& hand = context_.hand;
  if (!hand.isHeldBy(Hand::Manual)) return;
  const Part* part = context_.session.scene().find(hand.part().value_or(PartId{}));
  if (part == nullptr) return;
  const glm::dvec3 centre = massOfMoving(context_.session.scene()).properties.centre;
  moveHand(stepped(hand.handPose(), shift, turn, centre));
}

void HandControl::moveHand(const RigidTransform& worldFromPart) {
  const Scene& scene = context_.session.scene();
  const Part* part = scene.find(context_.hand.part().value_or(PartId{}));
  WorkspaceMapping locks;
  locks.translationLocks = scene.haptics().mapping.translationLocks;
  locks.rotationLocks = scene.haptics().mapping.rotationLocks;
  WorkspaceMapper mapper;
  mapper.engage(context_.hand.handPose());
  RigidTransform wanted = mapper.map(worldFromPart, false, locks);
  if (part != nullptr)
    wanted = jointsOfMoving(scene).nearestPose(wanted, massOfMoving(scene).properties.centre);
  context_.hand.setHandPose(wanted);
  emit handMoved(context_.hand.handPose());
}

void HandControl::letGo() {
  if (!context_.hand.isHeldBy(Hand::Manual)) return;
  context_.hand.setHandPose(context_.hand.partPose());
  emit handMoved(context_.hand.handPose());
}

}  // namespace nearfit::ui
