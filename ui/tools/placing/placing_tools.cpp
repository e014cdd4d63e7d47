#include "ui/tools/placing/placing_tools.h"

#include <QAction>
#include <QMainWindow>
#include <QMenu>
#include <QStringList>
#include <QToolBar>
#include <algorithm>
#include <utility>

#include <glm/gtc/quaternion.hpp>

#include "core/placing/jointed_motion.h"
#include "ui/model/joint_names.h"
#include "ui/model/move_guard.h"
#include "ui/model/pose_subject.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/tools/placing/gizmo_control.h"
#include "ui/tools/placing/placing_actions.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/names.h"

namespace nearfit::ui {

PlacingTools::PlacingTools(Session& session, Selection& selection, Viewport& view, const MoveGuard& guard,
                           SceneWork& work, QObject* parent)
    : QObject(parent),
      session_(session),
      selection_(selection),
      view_(view),
      guard_(guard),
      actions_(new PlacingActions(this)),
      control_(new GizmoControl(view)) {
  control_->setDirectDrag([this](const QPoint& position) { return grab(position); });
  connect(control_, &GizmoControl::began, this, &PlacingTools::begin);
  connect(control_, &GizmoControl::dragged, this, &PlacingTools::follow);
  connect(control_, &GizmoControl::ended, this, &PlacingTools::finish);
  connect(control_, &GizmoControl::cancelled, this, &PlacingTools::takeBack);
  connect(&mover_, &PartMover::moved, this, &PlacingTools::showMoved);
  connect(&mover_, &PartMover::ended, this, &PlacingTools::putMoved);
  connect(&mover_, &PartMover::failed, this, [this](const std::exception_ptr& error) {
    abandon();
    emit failed(describe(tr("The part could not be moved in Solid mode."), error));
  });
  connect(actions_, &PlacingActions::changed, this, &PlacingTools::showActions);
  connect(actions_->pivotAtMass, &QAction::triggered, this, [this] { setPivot(std::nullopt); });
  connect(actions_->pivotAtBox, &QAction::triggered, this, [this] {
    const std::vector<PlacedPart> parts = placedParts();
    if (!parts.empty()) setPivot(boxCentre(parts));
  });
  // Solid moves need hierarchies, which should not take time in a drag.
  connect(actions_->solid, &QAction::toggled, this, [this, &work](bool isOn) {
    if (isOn && !session_.scene().parts().empty()) work.prepareHierarchies([](bool) {});
  });
  connect(&work, &SceneWork::sceneNeeded, this, &PlacingTools::commit);
  connect(&selection_, &Selection::changed, this, [this] {
    // What has left the scene cannot be put anywhere.
    if (!isMoveSound()) giveUpParts();
    commit();
    abandon();
    showFrame();
  });
  const auto look = [this] {
    if (!isDragSound()) abandon();
    showFrame();
  };
  changes_ = session_.onChange(SceneEvents::Stage::Panels, look);
  connect(&guard_, &MoveGuard::changed, this, look);
  showActions();
}

QToolBar* PlacingTools::addTo(QMainWindow& window, QMenu& menu) {
  actions_->addTo(menu);
  window.addToolBarBreak();
  QToolBar* bar = actions_->makeToolBar(window);
  window.addToolBar(bar);
  return bar;
}

void PlacingTools::setHeld(const std::optional<HeldPart>& held) {
  const bool hasChanged = held.has_value() != held_.has_value() || (held && held->part != held_->part);
  held_ = held;
  if (hasChanged || !isDragSound()) abandon();
  showFrame();
  if (drag_ == Drag::Hand) control_->showReached(heldPose() * heldAtStart_.inverse(), {});
}

void PlacingTools::setAside(bool isAside) {
  isAside_ = isAside;
  showFrame();
}

bool PlacingTools::isDragSound() const {
  return drag_ == Drag::Hand || drag_ == Drag::Pivot ? frame().has_value() : isMoveSound();
}

/// True if the parts that move are still where they started, in the scene, and may be moved.
bool PlacingTools::isMoveSound() const {
  return std::ranges::all_of(mover_.start(), [this](const auto& entry) {
    const auto& [id, pose] = entry;
    const Part* part = session_.scene().find(id);
    return part != nullptr && isMovable(*part) && part->worldFromPart == pose;
  });
}

void PlacingTools::showActions() {
  // A pivot can be moved, but not turned.
  control_->setMode(actions_->movePivot->isChecked() ? GizmoMode::Move : actions_->mode());
  control_->setSteps(actions_->steps());
  control_->setSnapping(actions_->snap->isChecked());
  showFrame();
}

/// Sets the pivot of all selected parts; nullopt: back to their centre of mass.
void PlacingTools::setPivot(const std::optional<glm::dvec3>& inWorld) {
  commit();
  std::vector<Session::NewPivot> pivots;
  for (const PlacedPart& placed : placedParts()) {
    const RigidTransform partFromWorld = placed.worldFromPart.inverse();
    pivots.push_back({placed.part->id, {}});
    if (inWorld) pivots.back().inPart = partFromWorld.applyToPoint(*inWorld);
  }
  try {
    session_.setPivots(pivots);
  } catch (...) {
    emit failed(describe(tr("The pivot could not be moved."), std::current_exception()));
  }
}

bool PlacingTools::isMovable(const Part& part) const {
  if (part.geometry == nullptr || !guard_.refusalOf(part).isEmpty()) return false;
  return !held_ || held_->part != part.id || leadsHand();
}

bool PlacingTools::leadsHand() const {
  return held_ && held_->isManual && selection_.parts() == std::vector{held_->part};
}

/// Where the servo has the part in hand; only while there is one.
RigidTransform PlacingTools::heldPose() const {
  return view_.poses().poseOf(*session_.scene().find(held_->part));
}

/// Returns the selected parts; empty if one of them may not be moved.
std::vector<PlacedPart> PlacingTools::placedParts() const {
  return placed(selection_.parts());
}

std::vector<PlacedPart> PlacingTools::placed(const std::vector<PartId>& parts) const {
  std::vector<PlacedPart> placed;
  for (const PartId id : parts) {
    const Part* part = session_.scene().find(id);
    if (part == nullptr || !isMovable(*part)) return {};
    placed.push_back({part, view_.poses().poseOf(*part)});
  }
  return placed;
}

std::optional<GizmoFrame> PlacingTools::frame() const {
  const std::vector<PlacedPart> parts = placedParts();
  if (isAside_ || parts.empty() ||
      !std::ranges::all_of(parts, [](const PlacedPart& p) { return p.part->isVisible; }))
    return std::nullopt;
  GizmoFrame frame;
  const std::optional<glm::dvec3> given = draggedPivot_ ? draggedPivot_ : sharedPivot(parts);
  frame.pivot = given ? *given : centreOfMass(parts);
  if (!actions_->localAxes->isChecked()) return frame;
  // The pose panel shows the part that leads, so use its axes too.
  const Part& lead = session_.scene().get(leadOf(session_.scene(), selection_));
  frame.axes = glm::mat3_cast(view_.poses().poseOf(lead).rotation);
  return frame;
}

void PlacingTools::showFrame() {
  control_->setFrame(frame());
}

std::optional<glm::dvec3> PlacingTools::grab(const QPoint& position) const {
  if (actions_->movePivot->isChecked()) return std::nullopt;
  const std::vector<PlacedPart> parts = placedParts();
  const ViewRay ray = view_.projection().rayThrough({position.x(), position.y()});
  // Picking is slow with many triangles, so try the bounding boxes first.
  if (std::ranges::none_of(parts, [&](const PlacedPart& part) { return meetsBox(ray, part); }))
    return std::nullopt;
  const std::optional<PickedPoint> picked = view_.pointAt(position);
  if (!picked || !selection_.contains(picked->part)) return std::nullopt;
  return picked->point;
}

void PlacingTools::begin(GizmoGrip handle) {
  // Parts still settling from the last drag stay where they are.
  commit();
  handle_ = handle;
  if (actions_->movePivot->isChecked()) {
    drag_ = Drag::Pivot;
  } else if (leadsHand()) {
    drag_ = Drag::Hand;
    handAtStart_ = held_->worldFromHand;
    heldAtStart_ = heldPose();
  } else {
    drag_ = Drag::Parts;
    mover_.begin(sceneNow(), selection_.parts(), actions_->solid->isChecked());
  }
}

Scene PlacingTools::sceneNow() const {
  Scene scene = session_.scene();
  const Part* inHand = held_ ? scene.find(held_->part) : nullptr;
  if (inHand != nullptr) {
    Part moved = *inHand;
    moved.worldFromPart = view_.poses().poseOf(*inHand);
    scene.replace(std::move(moved));
  }
  return scene;
}

void PlacingTools::bring(const std::vector<PartId>& parts, PartId lead, const RigidTransform& worldFromLead,
                         const char* verb) {
  commit();
  const QString refusal = guard_.refusalOf(parts);
  if (!refusal.isEmpty()) return emit noted(refusal);
  const Scene scene = sceneNow();
  const RigidTransform start = scene.get(lead).worldFromPart;
  const RigidTransform wanted = (worldFromLead * start.inverse()).normalized();
  const JointedMotion joints(scene, parts);
  const RigidTransform motion = joints.nearest(wanted);
  // Without joints the pose is exactly the given one.
  Brought brought{lead, joints.isFree() ? worldFromLead : (motion * start).normalized(), verb};
  if (joints.areApart(wanted, motion)) brought.note = heldText(scene, parts);
  if (!brought.note.isEmpty()) emit noted(brought.note);
  if (placed(parts).empty() || !actions_->solid->isChecked()) return put(parts, brought);
  handle_ = GizmoGrip::None;
  brought_ = brought;
  mover_.begin(scene, parts, true);
  mover_.moveTo(motion);
  mover_.end();
}

void PlacingTools::follow(const RigidTransform& motion) {
  switch (drag_) {
    case Drag::Parts:
      return mover_.moveTo(motion);
    case Drag::Hand:
      return emit handWanted((motion * handAtStart_).normalized());
    case Drag::Pivot:
      draggedPivot_ = motion.applyToPoint(control_->frameAtStart().pivot);
      showFrame();
      return control_->showReached(motion, {});
    case Drag::None:
      return;
  }
}

void PlacingTools::showMoved() {
  view_.poses().show(ShownPoses::Source::Drag, mover_.poses());
  showFrame();
  control_->showReached(mover_.motion(), note());
}

QString PlacingTools::note() const {
  constexpr int kNamed = 3;
  if (mover_.isPreparing()) return tr("Preparing contact…");
  if (mover_.isHeldByJoints() && mover_.touching().empty()) return tr("Held by joints");
  QStringList names;
  for (const PartId id : mover_.touching()) {
    const Part* part = session_.scene().find(id);
    if (part != nullptr) names << QString::fromStdString(part->name);
  }
  return names.isEmpty() ? QString() : tr("Stopped by %1").arg(listOfNames(names, kNamed));
}

void PlacingTools::finish() {
  const Drag drag = std::exchange(drag_, Drag::None);
  if (drag == Drag::Parts) mover_.end();
  if (drag == Drag::Pivot) setPivot(std::exchange(draggedPivot_, std::nullopt));
}

void PlacingTools::takeBack() {
  const Drag drag = std::exchange(drag_, Drag::None);
  if (drag == Drag::Parts) {
    abandon();
  } else if (drag == Drag::Hand) {
    emit handWanted(handAtStart_);
  }
  draggedPivot_.reset();
  showFrame();
}

void PlacingTools::commit() {
  if (mover_.isEnding()) mover_.endHere();
}

void PlacingTools::abandon() {
  drag_ = Drag::None;
  draggedPivot_.reset();
  control_->abandon();
  giveUpParts();
}

/// Shows the parts at their poses in the scene again.
void PlacingTools::giveUpParts() {
  brought_.reset();
  if (mover_.isUnderWay()) mover_.giveUp();
  view_.poses().show(ShownPoses::Source::Drag, {});
}

void PlacingTools::putMoved() {
  Brought where = brought_.value_or(Brought{mover_.parts().back(), {}, isRing(handle_) ? "Turn" : "Move"});
  if (!brought_ || !mover_.hasArrived()) where.worldFromLead = mover_.poses().at(where.lead);
  // What was noted before ended with the state of the scene.
  const QString told = brought_ && !mover_.hasArrived() ? note() : where.note;
  const std::vector<PartId> parts = mover_.parts();
  // The move is over before the session tells that the parts are elsewhere, which would end it otherwise. They
  // are shown as dragged until then.
  mover_.giveUp();
  put(parts, where);
  giveUpParts();
  showFrame();
  if (!told.isEmpty()) emit noted(told);
}

/// Moves the parts together so that the lead gets its pose.
void PlacingTools::put(const std::vector<PartId>& parts, const Brought& where) {
  try {
    session_.moveParts(parts, where.lead, where.worldFromLead, where.verb);
  } catch (...) {
    emit failed(describe(tr("The part could not be moved."), std::current_exception()));
  }
}

}  // namespace nearfit::ui
