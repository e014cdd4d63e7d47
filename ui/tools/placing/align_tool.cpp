#include "ui/tools/placing/align_tool.h"

#include <QAction>
#include <QSignalBlocker>
#include <algorithm>
#include <utility>
#include <vector>

#include "core/placing/jointed_motion.h"
#include "ui/model/hand_state.h"
#include "ui/model/joint_names.h"
#include "ui/model/move_guard.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/tools/placing/align_bar.h"
#include "ui/tools/placing/placing_tools.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

AlignTool::AlignTool(const Context& context, QObject* parent)
    : QObject(parent),
      session_(context.session),
      selection_(context.selection),
      view_(context.view),
      guard_(context.guard),
      hand_(context.hand),
      work_(context.work),
      placing_(context.placing),
      bar_(new AlignBar(&view_)),
      picker_(session_, view_, colours::kAccent, this),
      movingLight_(view_.overlay(), colours::kMoving),
      fixedLight_(view_.overlay(), colours::kHand),
      rule_(&alignRules().front()) {
  makeActions();
  connectTool();
  updateAvailability();
}

AlignTool::~AlignTool() = default;

void AlignTool::makeActions() {
  for (const AlignRule& rule : alignRules()) {
    QAction* action = makeAction(this, rule.name, tr(rule.text), QLatin1String(rule.icon),
                                 QKeySequence(QLatin1String(rule.keys)), tr(rule.help));
    action->setCheckable(true);
    connect(action, &QAction::toggled, this, [this, &rule](bool isOn) { isOn ? start(rule) : stop(); });
    actions_ << action;
  }
}

void AlignTool::connectTool() {
  connect(&picker_, &FeaturePicker::picked, this, &AlignTool::take);
  connect(&picker_, &FeaturePicker::told, this, &AlignTool::tell);
  connect(&picker_, &FeaturePicker::accepted, this, &AlignTool::apply);
  connect(&picker_, &FeaturePicker::cancelled, this, &AlignTool::stop);
  connect(bar_, &AlignBar::filterChosen, &picker_, &FeaturePicker::setFilter);
  connect(bar_, &AlignBar::optionsEdited, this, &AlignTool::preview);
  connect(bar_, &AlignBar::applied, this, &AlignTool::apply);
  connect(bar_, &AlignBar::cancelled, this, &AlignTool::stop);
  connect(&view_, &Viewport::posesChanged, this, &AlignTool::showLights);
  const auto look = [this] {
    if (picker_.isActive() && !isSound()) stop();
    updateAvailability();
  };
  changes_ = session_.onChange(SceneEvents::Stage::Panels, look);
  connect(&guard_, &MoveGuard::changed, this, look);
  // The picked part may be in hand now, or no more.
  connect(&hand_, &HandState::changed, this, [this, look] {
    stop();
    look();
  });
  connect(&work_, &SceneWork::busyChanged, this, look);
}

bool AlignTool::canUse(const AlignRule& rule) const {
  // While the servo holds a part, the hand moves it.
  const bool isFree = rule.joint || !hand_.status().isTaken();
  return isFree && session_.scene().parts().size() > 1;
}

void AlignTool::updateAvailability() {
  if (!canUse(*rule_)) stop();
  for (int i = 0; i < actions_.size(); ++i) {
    const AlignRule& rule = alignRules()[static_cast<std::size_t>(i)];
    // A tool that has started goes on while something is prepared.
    actions_[i]->setEnabled(canUse(rule) && (!work_.isBusy() || (picker_.isActive() && rule_ == &rule)));
  }
}

void AlignTool::start(const AlignRule& rule) {
  stop();
  rule_ = &rule;
  QAction* action = actions_[static_cast<int>(&rule - alignRules().data())];
  const QSignalBlocker blocker(action);
  action->setChecked(true);
  bar_->reset(!rule.filter);
  picker_.setFilter(rule.filter.value_or(bar_->filter()));
  picker_.start([this](const Part& part) { return refusalOf(part); });
  bar_->show();
  tell({});
  placing_.setAside(true);
}

void AlignTool::stop() {
  for (QAction* action : actions_) {
    const QSignalBlocker blocker(action);
    action->setChecked(false);
  }
  if (!picker_.isActive()) return;
  // Before picker_.stop(), which reports once more what it shows: these parts may have left the scene.
  moving_.reset();
  fixed_.reset();
  joint_.reset();
  isContradicting_ = false;
  picker_.stop();
  bar_->hide();
  view_.poses().show(ShownPoses::Source::Preview, {});
  movingLight_.clear();
  fixedLight_.clear();
  start_.clear();
  view_.requestRender();
  placing_.setAside(false);
}

bool AlignTool::isMoved(PartId part) const {
  return start_.contains(part);
}

/// True if what was picked is still where it was.
bool AlignTool::isSound() const {
  if (moving_ && sceneSerial_ != session_.sceneSerial()) return false;
  if (fixed_ && session_.scene().find(fixed_->part) == nullptr) return false;
  return std::all_of(start_.begin(), start_.end(), [this](const auto& entry) {
    const Part* part = session_.scene().find(entry.first);
    return part != nullptr && refusalToMove(*part).isEmpty() && part->worldFromPart == entry.second;
  });
}

QString AlignTool::refusalToMove(const Part& part) const {
  if (!rule_->joint) return guard_.refusalOf(part);
  const QString name = shortName(part.name);
  const std::size_t joints = jointsOfParts(session_.scene(), {part.id}).size();
  if (joints >= kMaxJointsPerPart)
    return tr("%1 has %2 joints already: remove one of them first").arg(name).arg(joints);
  // The servo leads the part in hand onto its joints.
  return hand_.holds(part.id) ? QString() : guard_.refusalOf(part);
}

QString AlignTool::refusalOf(const Part& part) const {
  if (moving_) {
    return isMoved(part.id) ? tr("%1 is the part that moves: click another part").arg(shortName(part.name))
                            : QString();
  }
  const QString refusal = refusalToMove(part);
  if (!refusal.isEmpty() || rule_->joint || !selection_.contains(part.id)) return refusal;
  const QString ofOthers = guard_.refusalOf(selection_.parts());
  return ofOthers.isEmpty() ? QString() : tr("Also selected: %1").arg(ofOthers);
}

void AlignTool::take(const FeaturePick& pick) {
  const Part* part = session_.scene().find(pick.part);
  if (part == nullptr) return;
  moving_ ? takeFixed(pick, *part) : takeMoving(pick, *part);
  tell({});
  view_.requestRender();
}

AlignTool::Picked AlignTool::pickedBy(const FeaturePick& pick, const Part& part) const {
  const AlignFeature feature = rule_->featureOf(part.geometry->mesh, pick.picked);
  const bool isAxisOfCircle =
      pick.picked.feature.shape == FeatureShape::Circle && feature.shape == FeatureShape::Axis;
  // A joint on an axis never looks for a face.
  return {pick.part, feature, isAxisOfCircle && !rule_->joint};
}

void AlignTool::takeMoving(const FeaturePick& pick, const Part& part) {
  if (!selection_.contains(pick.part)) selection_.select(pick.part);
  const std::vector<PartId> moved = rule_->joint ? std::vector{pick.part} : selection_.parts();
  for (const PartId id : moved)
    start_[id] = session_.scene().find(id)->worldFromPart;
  moving_ = pickedBy(pick, part);
  sceneSerial_ = session_.sceneSerial();
  movingLight_.show(part.geometry->mesh, pick.picked, view_.poses().shownPoseOf(part));
  picker_.start([this](const Part& other) { return refusalOf(other); });
}

void AlignTool::takeFixed(const FeaturePick& pick, const Part& part) {
  fixed_ = pickedBy(pick, part);
  fixedLight_.show(part.geometry->mesh, pick.picked, view_.poses().shownPoseOf(part));
  showOptions();
  preview();
}

void AlignTool::showOptions() {
  const FeatureShape moving = moving_->inPart.shape, fixed = fixed_->inPart.shape;
  // A joint keeps one part: it would not take the others along.
  const bool canKeep = !rule_->joint && start_.size() == 1 && jointKindOf(moving, fixed).has_value();
  bar_->showPair(AlignBar::Options{canBeFlipped(moving, fixed), rule_->canBeApart(moving, fixed), canKeep});
}

std::optional<JointKind> AlignTool::jointKind() const {
  if (rule_->joint) return rule_->joint;
  return bar_->isKept() ? jointKindOf(moving_->inPart.shape, fixed_->inPart.shape) : std::nullopt;
}

FeatureAt AlignTool::placedNow(const Picked& picked) const {
  return {picked.part, picked.inPart, view_.poses().poseOf(*session_.scene().find(picked.part))};
}

void AlignTool::preview() {
  if (!moving_ || !fixed_) return;
  const FeatureAt moving = placedNow(*moving_), fixed = placedNow(*fixed_);
  const RigidTransform motion =
      rule_->motion(placed(moving.inPart, moving.worldFromPart), placed(fixed.inPart, fixed.worldFromPart),
                    {bar_->isFlipped(), bar_->offset()});
  joint_.reset();
  isContradicting_ = false;
  jointKind() ? previewJoint(motion) : previewMove(motion);
  bar_->setApplicable(!isContradicting_);
  tell({});
}

/// Shows the parts after a motion, as far as their joints allow it.
void AlignTool::previewMove(const RigidTransform& wanted) {
  std::vector<PartId> parts;
  parts.reserve(start_.size());
  for (const auto& [id, pose] : start_)
    parts.push_back(id);
  const RigidTransform motion = JointedMotion(session_.scene(), parts).nearest(wanted);
  ShownPoses::Poses poses;
  for (const auto& [id, pose] : start_)
    poses[id] = (motion * pose).normalized();
  pose_ = poses.at(moving_->part);
  view_.poses().show(ShownPoses::Source::Preview, std::move(poses));
}

/// Shows the part on the joint that Apply would make. A part in hand stays there: the servo will lead it.
void AlignTool::previewJoint(const RigidTransform& wanted) {
  FeatureAt moving = placedNow(*moving_);
  moving.worldFromPart = (wanted * moving.worldFromPart).normalized();
  joint_ = jointBetween(*jointKind(), moving, placedNow(*fixed_), bar_->offset());
  std::optional<RigidTransform> pose;
  try {
    pose = keptPose(placing_.sceneNow(), *joint_, moving.worldFromPart);
  } catch (...) {
    joint_.reset();
    isContradicting_ = true;
    view_.poses().show(ShownPoses::Source::Preview, {});
    return emit failed(describe(tr("The joint cannot be made."), std::current_exception()));
  }
  isContradicting_ = !pose;
  const Part& part = *session_.scene().find(moving.part);
  const bool isInHand = hand_.holds(moving.part);
  pose_ = isInHand ? part.worldFromPart : pose.value_or(part.worldFromPart);
  ShownPoses::Poses poses;
  if (pose && !isInHand) poses[moving.part] = *pose;
  view_.poses().show(ShownPoses::Source::Preview, std::move(poses));
}

/// The highlights follow their parts, as previewed or in hand.
void AlignTool::showLights() {
  const auto follow = [this](const std::optional<Picked>& picked, FeatureHighlight& light) {
    const Part* part = picked ? session_.scene().find(picked->part) : nullptr;
    if (part != nullptr) light.setPose(view_.poses().shownPoseOf(*part));
  };
  follow(moving_, movingLight_);
  follow(fixed_, fixedLight_);
}

void AlignTool::apply() {
  if (!moving_ || !fixed_ || isContradicting_) return;
  if (joint_) return applyJoint();
  const PartId lead = moving_->part;
  const RigidTransform pose = pose_;
  std::vector<PartId> moved;
  moved.reserve(start_.size());
  for (const auto& [id, was] : start_)
    moved.push_back(id);
  const char* verb = rule_->verb;
  stop();
  placing_.bring(moved, lead, pose, verb);
}

void AlignTool::applyJoint() {
  const Joint joint = *joint_;
  const RigidTransform pose = pose_;
  stop();
  placing_.commit();
  try {
    session_.addJoint(joint, pose);
  } catch (...) {
    return emit failed(describe(tr("The joint could not be made."), std::current_exception()));
  }
  emit noted(tr("%1: %2").arg(shortName(session_.scene().get(joint.part).name),
                              jointText(session_.scene(), session_.scene().joints().back())));
}

QString AlignTool::prompt() const {
  if (!moving_) return tr(rule_->movingPrompt);
  if (!fixed_) return tr(rule_->fixedPrompt);
  return tr("%1 to %2").arg(describeFeature(moving_->inPart), describeFeatureWithin(fixed_->inPart));
}

QString AlignTool::idleHint() const {
  if (!moving_) {
    return rule_->joint ? tr("Locked parts cannot be kept; the part moves onto the other one")
                        : tr("Locked parts don't move; selected parts move together");
  }
  if (!fixed_) {
    if (moving_->isUnseated) {
      return tr("No flat face at this edge of %1: only its axis counts")
          .arg(shortName(session_.scene().find(moving_->part)->name));
    }
    return tr("%1 of %2")
        .arg(describeFeature(moving_->inPart), shortName(session_.scene().find(moving_->part)->name));
  }
  if (isContradicting_) {
    return tr("Contradicts other joints of %1: turn one of them off, or click another")
        .arg(shortName(session_.scene().find(moving_->part)->name));
  }
  if (moving_->isUnseated || fixed_->isUnseated)
    return tr("No flat face at this edge: only the axes become one. Enter applies, Esc cancels");
  return tr("Enter applies, Esc cancels; click again to change the target");
}

void AlignTool::tell(const QString& hint) {
  bar_->showPrompt(prompt(), hint.isEmpty() ? idleHint() : hint);
}

}  // namespace nearfit::ui
