#include "ui/tools/placing/align_tool.h"

#include <QAction>
#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <algorithm>
#include <utility>

#include "ui/model/hand_state.h"
#include "ui/model/move_guard.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/model/shown_poses.h"
#include "ui/tools/placing/placing_tools.h"
#include "ui/view3d/viewport.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/names.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr double kFarthest = 1e3;  ///< [m]

}  // namespace

AlignBar::AlignBar(QWidget* view)
    : ViewBar(view, QStringLiteral("alignBar")),
      prompt_(new QLabel(this)),
      hint_(new QLabel(this)),
      filter_(new QComboBox(this)),
      flip_(new QCheckBox(tr("&Flip"), this)),
      offsetLabel_(new QLabel(tr("Distance"), this)),
      offset_(new NumberField(this)),
      apply_(new QPushButton(tr("Apply"), this)),
      cancel_(new QPushButton(tr("Cancel"), this)) {
  setUpFields();
  auto* fields = new QHBoxLayout;
  fields->setSpacing(8);
  for (QWidget* widget :
       {static_cast<QWidget*>(filter_), static_cast<QWidget*>(flip_), static_cast<QWidget*>(offsetLabel_),
        static_cast<QWidget*>(offset_), static_cast<QWidget*>(apply_), static_cast<QWidget*>(cancel_)})
    fields->addWidget(widget);
  fields->insertStretch(4);
  auto* rows = new QVBoxLayout(this);
  rows->setContentsMargins(14, 8, 12, 10);
  rows->setSpacing(3);
  rows->addWidget(prompt_);
  rows->addWidget(hint_);
  rows->addLayout(fields);
}

void AlignBar::setUpFields() {
  prompt_->setObjectName(QStringLiteral("alignPrompt"));
  prompt_->setStyleSheet(QStringLiteral("font-weight: bold"));
  hint_->setObjectName(QStringLiteral("alignHint"));
  hint_->setMinimumWidth(forFont(*this, 430));
  hint_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  filter_->setObjectName(QStringLiteral("alignFilter"));
  filter_->setAccessibleName(tr("What can be picked"));
  filter_->setToolTip(tr("What can be picked; corners and edges within a few pixels of the pointer"));
  filter_->addItem(tr("Anything"), static_cast<int>(FeatureFilter::Any));
  filter_->addItem(tr("Flat faces"), static_cast<int>(FeatureFilter::Faces));
  filter_->addItem(tr("Axes and edges"), static_cast<int>(FeatureFilter::Axes));
  filter_->addItem(tr("Points"), static_cast<int>(FeatureFilter::Points));
  flip_->setObjectName(QStringLiteral("alignFlip"));
  flip_->setToolTip(
      tr("Turn the part around: faces point the same way, or axes run in opposite directions"));
  offsetLabel_->setBuddy(offset_);
  offset_->setObjectName(QStringLiteral("alignOffset"));
  offset_->setAccessibleName(tr("Distance"));
  offset_->setLength(4);
  offset_->setQuantityRange(-kFarthest, kFarthest);
  offset_->setQuantityStep(1e-3);
  offset_->setToolTip(tr("Distance between the two, outward from the target"));
  apply_->setObjectName(QStringLiteral("alignApply"));
  apply_->setToolTip(tr("Move the part there, as one undo step (Enter)"));
  cancel_->setObjectName(QStringLiteral("alignCancel"));
  cancel_->setToolTip(tr("Cancel without moving anything (Esc)"));
  connect(filter_, QOverload<int>::of(&QComboBox::currentIndexChanged), this,
          [this] { emit filterChosen(filter()); });
  connect(flip_, &QCheckBox::toggled, this, &AlignBar::optionsEdited);
  connect(offset_, &NumberField::quantityEdited, this, &AlignBar::optionsEdited);
  connect(apply_, &QPushButton::clicked, this, [this] {
    offset_->settle();
    if (!offset_->isFaulty()) emit applied();
  });
  connect(cancel_, &QPushButton::clicked, this, &AlignBar::cancelled);
}

void AlignBar::showPrompt(const QString& prompt, const QString& hint) {
  prompt_->setText(prompt);
  hint_->setText(hint.isEmpty() ? QStringLiteral(" ") : hint);
  place();
}

void AlignBar::showPair(bool isPicked, bool canFlip, bool canOffset) {
  flip_->setVisible(isPicked);
  flip_->setEnabled(canFlip);
  offsetLabel_->setVisible(isPicked && canOffset);
  offset_->setVisible(isPicked && canOffset);
  apply_->setEnabled(isPicked);
  place();
}

void AlignBar::reset() {
  const QSignalBlocker flipBlocker(flip_);
  flip_->setChecked(false);
  offset_->takeBack();
  offset_->showQuantity(0.0);
  showPair(false, false, false);
}

FeatureFilter AlignBar::filter() const {
  return static_cast<FeatureFilter>(filter_->currentData().toInt());
}

bool AlignBar::isFlipped() const {
  return flip_->isChecked() && flip_->isEnabled();
}

double AlignBar::offset() const {
  return offset_->quantity();
}

AlignTool::AlignTool(const Context& context, QObject* parent)
    : QObject(parent),
      session_(context.session),
      selection_(context.selection),
      view_(context.view),
      guard_(context.guard),
      hand_(context.hand),
      work_(context.work),
      placing_(context.placing),
      action_(new QAction(icon(QStringLiteral("align")), tr("&Align…"), this)),
      bar_(new AlignBar(&view_)),
      picker_(session_, view_, colours::kAccent, this),
      movingLight_(view_.overlay(), colours::kMoving),
      fixedLight_(view_.overlay(), colours::kHand) {
  action_->setObjectName(QStringLiteral("align"));
  action_->setCheckable(true);
  action_->setShortcut(QKeySequence(Qt::Key_A));
  action_->setToolTip(tr("Align a face, axis or point of a part with one of another (A)"));
  connect(action_, &QAction::toggled, this, [this](bool isOn) { isOn ? start() : stop(); });
  connect(&picker_, &FeaturePicker::picked, this, &AlignTool::take);
  connect(&picker_, &FeaturePicker::told, this, &AlignTool::tell);
  connect(&picker_, &FeaturePicker::accepted, this, &AlignTool::apply);
  connect(&picker_, &FeaturePicker::cancelled, this, &AlignTool::stop);
  connect(bar_, &AlignBar::filterChosen, &picker_, &FeaturePicker::setFilter);
  connect(bar_, &AlignBar::optionsEdited, this, &AlignTool::preview);
  connect(bar_, &AlignBar::applied, this, &AlignTool::apply);
  connect(bar_, &AlignBar::cancelled, this, &AlignTool::stop);
  const auto look = [this] {
    if (picker_.isActive() && !isSound()) stop();
    updateAvailability();
  };
  changes_ = session_.onChange(SceneEvents::Stage::Panels, look);
  connect(&guard_, &MoveGuard::changed, this, look);
  connect(&hand_, &HandState::changed, this, look);
  connect(&work_, &SceneWork::busyChanged, this, look);
  updateAvailability();
}

AlignTool::~AlignTool() = default;

void AlignTool::updateAvailability() {
  // While the servo holds a part, the hand moves it.
  const bool canAlign = !hand_.status().isTaken() && session_.scene().parts().size() > 1;
  if (!canAlign) stop();
  // A tool that has started goes on while something is prepared.
  action_->setEnabled(canAlign && (!work_.isBusy() || picker_.isActive()));
}

void AlignTool::start() {
  bar_->reset();
  picker_.setFilter(bar_->filter());
  picker_.start([this](const Part& part) { return refusalOf(part); });
  bar_->show();
  tell({});
  placing_.setAside(true);
}

void AlignTool::stop() {
  const QSignalBlocker blocker(action_);
  action_->setChecked(false);
  if (!picker_.isActive()) return;
  // Before picker_.stop(), which reports once more what it shows: these parts may have left the scene.
  moving_.reset();
  fixed_.reset();
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
    return part != nullptr && guard_.refusalOf(*part).isEmpty() &&
           part->worldFromPart.translation == entry.second.translation &&
           part->worldFromPart.rotation == entry.second.rotation;
  });
}

QString AlignTool::refusalOf(const Part& part) const {
  const QString name = shortName(part.name);
  if (moving_)
    return isMoved(part.id) ? tr("%1 is the part that moves: click another part").arg(name) : QString();
  const QString refusal = guard_.refusalOf(part);
  if (!refusal.isEmpty() || !selection_.contains(part.id)) return refusal;
  const QString ofOthers = guard_.refusalOf(selection_.parts());
  return ofOthers.isEmpty() ? QString() : tr("Also selected: %1").arg(ofOthers);
}

void AlignTool::take(const FeaturePick& pick) {
  const Part* part = session_.scene().find(pick.part);
  if (part == nullptr) return;
  if (!moving_) {
    if (!selection_.contains(pick.part)) selection_.select(pick.part);
    for (const PartId id : selection_.parts())
      start_[id] = session_.scene().find(id)->worldFromPart;
    moving_ = pick;
    sceneSerial_ = session_.sceneSerial();
    movingLight_.show(part->geometry->mesh, pick.picked, part->worldFromPart);
    picker_.start([this](const Part& other) { return refusalOf(other); });
  } else {
    fixed_ = pick;
    fixedLight_.show(part->geometry->mesh, pick.picked, part->worldFromPart);
    bar_->showPair(true, canBeFlipped(moving_->picked.feature.shape, pick.picked.feature.shape),
                   canBeOffset(moving_->picked.feature.shape, pick.picked.feature.shape));
    preview();
  }
  tell({});
  view_.requestRender();
}

void AlignTool::preview() {
  if (!moving_ || !fixed_) return;
  const RigidTransform& worldFromMoving = start_.at(moving_->part);
  const AlignFeature moving = placed(moving_->picked.feature, worldFromMoving);
  const AlignFeature fixed =
      placed(fixed_->picked.feature, session_.scene().find(fixed_->part)->worldFromPart);
  motion_ = alignMotion(moving, fixed, {bar_->isFlipped(), bar_->offset()});
  ShownPoses::Poses poses;
  for (const auto& [id, pose] : start_)
    poses[id] = (motion_ * pose).normalized();
  movingLight_.setPose(poses.at(moving_->part));
  view_.poses().show(ShownPoses::Source::Preview, std::move(poses));
  tell({});
}

void AlignTool::apply() {
  if (!moving_ || !fixed_) return;
  const PartId lead = moving_->part;
  const RigidTransform pose = (motion_ * start_.at(lead)).normalized();
  std::vector<PartId> moved;
  moved.reserve(start_.size());
  for (const auto& [id, was] : start_)
    moved.push_back(id);
  stop();
  placing_.bring(moved, lead, pose, "Align");
}

QString AlignTool::prompt() const {
  if (!moving_) return tr("Click a face, axis or point of the part to move");
  if (!fixed_) return tr("Click the target");
  return tr("%1 to %2")
      .arg(describeFeature(moving_->picked.feature), describeFeature(fixed_->picked.feature).toLower());
}

void AlignTool::tell(const QString& hint) {
  const QString idle = !moving_  ? tr("Locked parts don't move; selected parts move together")
                       : !fixed_ ? tr("%1 of %2")
                                       .arg(describeFeature(moving_->picked.feature),
                                            shortName(session_.scene().find(moving_->part)->name))
                                 : tr("Enter applies, Esc cancels; click again to change the target");
  bar_->showPrompt(prompt(), hint.isEmpty() ? idle : hint);
}

}  // namespace nearfit::ui
