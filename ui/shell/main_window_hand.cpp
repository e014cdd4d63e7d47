// MainWindow: what keys, mouse and numbers do to the selected part and to the manual hand.
#include <QAction>

#include <glm/gtc/quaternion.hpp>

#include "core/haptics/workspace_mapper.h"
#include "ui/files/document.h"
#include "ui/model/move_guard.h"
#include "ui/model/selection.h"
#include "ui/panels/pose/pose_panel.h"
#include "ui/shell/actions.h"
#include "ui/shell/main_window.h"
#include "ui/tools/placing/placing_tools.h"
#include "ui/view3d/hand_drag.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/error_box.h"

namespace nearfit::ui {
namespace {

const glm::dquat kNoTurn(1.0, 0.0, 0.0, 0.0);

/// Returns the pose shifted, and turned about `centre`, in the world.
/// @param centre  In the part's frame [m].
RigidTransform stepped(const RigidTransform& worldFromPart, const glm::dvec3& shift, const glm::dquat& turn,
                       const glm::dvec3& centre) {
  const glm::dquat rotation =
      RigidTransform{turn * worldFromPart.rotation, glm::dvec3(0.0)}.normalized().rotation;
  return {rotation, worldFromPart.applyToPoint(centre) + shift - rotation * centre};
}

}  // namespace

void MainWindow::connectHand() {
  connect(viewport_, &Viewport::nudged, this, [this](int x, int y, int z) { nudge(glm::dvec3(x, y, z)); });
  connect(viewport_, &Viewport::turned, this, [this](int x, int y, int z) { turn(glm::dvec3(x, y, z)); });
  connect(&viewport_->handDrag(), &HandDrag::dragged, this, &MainWindow::dragHand);
  connect(actions_->letGo, &QAction::triggered, this, &MainWindow::letGo);
}

void MainWindow::connectPlacing() {
  connect(placing_, &PlacingTools::handWanted, this, &MainWindow::moveHand);
  connect(placing_, &PlacingTools::failed, this, [this](const Failure& failure) {
    showFailure(failure);
    showScene();
  });
  connect(placing_, &PlacingTools::noted, this, &MainWindow::showNote);
  connect(placing_, &PlacingTools::hierarchiesWanted, this,
          [this] { document_->prepareHierarchies([](bool) {}); });
  // A drag that is still settling must become a step before the one to undo.
  for (const QAction* action : {actions_->undo, actions_->redo})
    connect(action, &QAction::triggered, placing_, &PlacingTools::commit);
  connect(document_.get(), &Document::sceneNeeded, placing_, &PlacingTools::commit);
}

void MainWindow::showHeld() {
  using Holder = MoveGuard::Holder;
  guard_->setHolder(!servo_.isRunning             ? Holder::Nobody
                    : servo_.hand == Hand::Manual ? Holder::ManualHand
                    : servo_.hand == Hand::Device ? Holder::Device
                                                  : Holder::ScriptedHand);
  const std::optional<PartId> part = session_.scene().movingPart();
  if (!servo_.isRunning || !part) return placing_->setHeld({});
  placing_->setHeld(HeldPart{*part, handPose_, servo_.hand == Hand::Manual});
}

void MainWindow::moveSelected(const RigidTransform& worldFromPart) {
  const std::optional<PartId> part = selected();
  if (!part) return;
  const QString refusal = guard_->refusalOf(selection_->parts());
  if (!refusal.isEmpty()) return showNote(refusal);
  holds(part) ? moveHand(worldFromPart) : placing_->bring(worldFromPart);
}

void MainWindow::nudge(const glm::dvec3& direction) {
  stepSelected(direction * posePanel_->step(), kNoTurn);
}

void MainWindow::turn(const glm::dvec3& axis) {
  stepSelected(glm::dvec3(0.0), glm::angleAxis(posePanel_->turnStep(), axis));
}

void MainWindow::stepSelected(const glm::dvec3& shift, const glm::dquat& turn) {
  if (isHandManual()) return dragHand(shift, turn);
  placing_->commit();
  const std::optional<PartId> id = selected();
  const Part* part = id ? session_.scene().find(*id) : nullptr;
  if (part != nullptr) moveSelected(stepped(part->worldFromPart, shift, turn, part->geometry->mass.centre));
}

bool MainWindow::isHandManual() const {
  return servo_.isRunning && servo_.hand == Hand::Manual;
}

void MainWindow::dragHand(const glm::dvec3& shift, const glm::dquat& turn) {
  if (!isHandManual()) return;
  // Not from centreInPart_, which is unknown before the first snapshot.
  const Part* part = session_.scene().find(session_.scene().movingPart().value_or(PartId{}));
  if (part != nullptr) moveHand(stepped(handPose_, shift, turn, part->geometry->mass.centre));
}

void MainWindow::moveHand(const RigidTransform& worldFromPart) {
  WorkspaceMapping locks;
  locks.translationLocks = session_.scene().haptics().mapping.translationLocks;
  locks.rotationLocks = session_.scene().haptics().mapping.rotationLocks;
  WorkspaceMapper mapper;
  mapper.engage(handPose_);
  handPose_ = mapper.map(worldFromPart, false, locks);
  emit handMoved(handPose_);
}

void MainWindow::letGo() {
  if (!isHandManual()) return;
  handPose_ = poseOfMoving();
  emit handMoved(handPose_);
}

}  // namespace nearfit::ui
