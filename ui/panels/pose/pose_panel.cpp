#include "ui/panels/pose/pose_panel.h"

#include <QEvent>
#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QToolButton>
#include <algorithm>
#include <iterator>

#include "core/math/euler_angles.h"
#include "core/scene/scene.h"
#include "ui/widgets/elided_label.h"
#include "ui/widgets/format.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

constexpr double kFarthest = 1e4;  ///< [m]

/// True for a command of the window, such as Ctrl+S, that a line editor has no use for here. Editors claim
/// some of them all the same: Ctrl+E to go to the end of the line, Ctrl+D to delete.
bool isCommand(const QKeyEvent& key) {
  const Qt::KeyboardModifiers modifiers = key.modifiers() & ~Qt::ShiftModifier;
  if (modifiers != Qt::ControlModifier || key.key() < Qt::Key_A || key.key() > Qt::Key_Z) return false;
  const QKeySequence::StandardKey editing[] = {QKeySequence::Copy,  QKeySequence::Cut,
                                               QKeySequence::Paste, QKeySequence::Undo,
                                               QKeySequence::Redo,  QKeySequence::SelectAll};
  return std::none_of(std::begin(editing), std::end(editing),
                      [&](QKeySequence::StandardKey k) { return key.matches(k); });
}

}  // namespace

PosePanel::PosePanel(QWidget* parent) : QWidget(parent), heading_(new ElidedLabel(this)) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(10, 8, 10, 10);
  layout->setHorizontalSpacing(6);
  heading_->setObjectName(QStringLiteral("poseHeading"));
  layout->addWidget(heading_, 0, 0, 1, 4);
  setUpPose(*layout);
  setUpMass(*layout);
  setUpJoints(*layout);
  layout->setColumnStretch(1, 3);
  layout->setColumnStretch(3, 2);
  layout->setRowStretch(9, 1);
  showPart({});
  showMass({});
  showCentre({});
  showJoints({});
}

void PosePanel::setUpPose(QGridLayout& layout) {
  const QStringList axes = {QStringLiteral("X"), QStringLiteral("Y"), QStringLiteral("Z")};
  for (int axis = 0; axis < 3; ++axis) {
    NumberField* field = makeLength(QStringLiteral("position") + axes[axis], kFarthest, 4, 1e-3);
    field->setAccessibleName(tr("Position along %1").arg(axes[axis]));
    fields_[static_cast<std::size_t>(axis)] = field;
    layout.addWidget(new QLabel(axes[axis], this), axis + 1, 0);
    layout.addWidget(field, axis + 1, 1);
  }
  // Made after all positions: the Tab key goes through the fields in this order.
  for (int axis = 0; axis < 3; ++axis) {
    NumberField* field = makeAngle(QStringLiteral("rotation") + axes[axis], 360.0);
    field->setAccessibleName(tr("Rotation about %1").arg(axes[axis]));
    fields_[3 + static_cast<std::size_t>(axis)] = field;
    layout.addWidget(new QLabel(QStringLiteral("R") + axes[axis].toLower(), this), axis + 1, 2);
    layout.addWidget(field, axis + 1, 3);
  }
  step_ = makeLength(QStringLiteral("nudgeStep"), 10.0, 3, 1e-4);
  step_->setQuantityRange(1e-6, 10.0);
  step_->showQuantity(1e-4);
  step_->setToolTip(tr("How far the arrow and page keys move the part while the 3-D view has the focus"));
  turnStep_ = makeAngle(QStringLiteral("turnStep"), 90.0);
  turnStep_->setMinimum(1e-3);
  turnStep_->setValue(1.0);
  turnStep_->setToolTip(tr("How far the arrow and page keys rotate the part with Shift, about its pivot"));
  auto* stepLabel = new QLabel(tr("Arrow-key step"), this);
  stepLabel->setBuddy(step_);
  turnStep_->setAccessibleName(tr("Arrow-key step of rotation"));
  layout.addWidget(stepLabel, 4, 0, 1, 4);
  layout.addWidget(step_, 5, 1);
  layout.addWidget(turnStep_, 5, 3);
  for (int field = 0; field < 6; ++field) {
    connect(fields_[static_cast<std::size_t>(field)], &NumberField::quantityEdited, this,
            [this, field] { edit(field); });
  }
}

void PosePanel::setUpMass(QGridLayout& layout) {
  density_ = prepared(new NumberField(this), QStringLiteral("density"), QStringLiteral("00000.0 kg/m³"));
  density_->setUnit(tr(" kg/m³"));
  density_->setDecimals(3);
  density_->setQuantityRange(kMinDensity, kMaxDensity);
  density_->setTrimmed(true);
  density_->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
  density_->setToolTip(
      tr("Density of the part's material: water 1000, aluminium 2700, steel 7850 kg/m³; from %1 to %2")
          .arg(formatNumber(kMinDensity), formatNumber(kMaxDensity)));
  mass_ = new QLabel(this);
  mass_->setObjectName(QStringLiteral("mass"));
  mass_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  auto* row = new QHBoxLayout;
  row->addWidget(new QLabel(tr("Density"), this));
  row->addWidget(density_, 1);
  row->addWidget(mass_);
  layout.addLayout(row, 6, 0, 1, 4);
  centre_ = new ElidedLabel(this);
  centre_->setObjectName(QStringLiteral("massCentre"));
  layout.addWidget(centre_, 7, 0, 1, 4);
  connect(density_, &NumberField::quantityEdited, this, &PosePanel::densityEdited);
}

void PosePanel::setUpJoints(QGridLayout& layout) {
  jointRow_ = new QWidget(this);
  joints_ = new ElidedLabel(jointRow_);
  joints_->setObjectName(QStringLiteral("joints"));
  joints_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kJointText.name()));
  removeJoints_ = new QToolButton(jointRow_);
  removeJoints_->setObjectName(QStringLiteral("removeJoints"));
  removeJoints_->setIcon(icon(QStringLiteral("close")));
  removeJoints_->setAutoRaise(true);
  removeJoints_->setToolTip(tr("Remove all joints of the part; it stays where it is"));
  removeJoints_->setAccessibleName(tr("Remove joints"));
  auto* row = new QHBoxLayout(jointRow_);
  row->setContentsMargins(0, 0, 0, 0);
  row->addWidget(joints_, 1);
  row->addWidget(removeJoints_);
  layout.addWidget(jointRow_, 8, 0, 1, 4);
  connect(removeJoints_, &QToolButton::clicked, this, &PosePanel::jointRemovalRequested);
}

NumberField* PosePanel::makeLength(const QString& name, double limit, int decimals, double step) {
  // Lengths below a kilometre have up to eight digits.
  NumberField* field = prepared(new NumberField(this), name, QStringLiteral("-000000.00 mm"));
  field->setLength(decimals);
  field->setQuantityRange(-limit, limit);
  field->setQuantityStep(step);
  return field;
}

NumberField* PosePanel::makeAngle(const QString& name, double limit) {
  NumberField* field = prepared(new NumberField(this), name, QStringLiteral("-000.000°"));
  field->setUnit(QString(QChar(0xB0)));
  field->setDecimals(3);
  field->setRange(-limit, limit);
  return field;
}

NumberField* PosePanel::prepared(NumberField* field, const QString& name, const QString& widest) {
  field->setActingAtOnce();
  field->setObjectName(name);
  // Wide enough beside the arrows, in any font size.
  constexpr int kArrows = 26;
  field->setMinimumWidth(field->fontMetrics().horizontalAdvance(widest) + kArrows);
  field->findChild<QLineEdit*>()->installEventFilter(this);
  field->installEventFilter(this);
  return field;
}

bool PosePanel::eventFilter(QObject* watched, QEvent* event) {
  // A line editor claims the undo keys even if it has nothing to undo; then they are meant for the scene.
  if (event->type() == QEvent::ShortcutOverride) {
    auto* key = static_cast<QKeyEvent*>(event);
    auto* editor = qobject_cast<QLineEdit*>(watched);
    if (editor == nullptr) editor = watched->findChild<QLineEdit*>();
    if (isCommand(*key)) {
      commit();
      event->ignore();
      return true;
    }
    const bool isUndo = key->matches(QKeySequence::Undo) || key->matches(QKeySequence::Redo);
    if (isUndo && editor != nullptr && !editor->isModified()) {
      event->ignore();
      return true;
    }
  }
  return QWidget::eventFilter(watched, event);
}

void PosePanel::showPart(const QString& name, const QString& refusal, const QString& help) {
  const QString heading = name.isEmpty() ? tr("No part selected") : name;
  // Text typed for one part is not meant for another.
  if (heading != heading_->text()) {
    for (NumberField* field : fields_)
      if (field->isUnsettled()) field->takeBack();
  }
  heading_->setText(heading);
  heading_->setToolTip(help);
  heading_->setStyleSheet(name.isEmpty() ? QStringLiteral("color: %1").arg(colours::kMutedText.name())
                                         : QStringLiteral("font-weight: bold"));
  for (NumberField* field : fields_) {
    field->setEnabled(!name.isEmpty() && refusal.isEmpty());
    field->setToolTip(refusal);
  }
  if (name.isEmpty()) showPose({});
}

void PosePanel::showPose(const RigidTransform& worldFromPart) {
  const bool isSame = worldFromPart == pose_;
  for (NumberField* field : fields_)
    if (!isSame && !isEditing_ && field->isFaulty()) field->takeBack();
  showPose(worldFromPart, worldFromPart);
}

void PosePanel::showPose(const RigidTransform& worldFromPart, const RigidTransform& worldFromHand) {
  pose_ = worldFromPart;
  hand_ = worldFromHand;
  handAngles_ = eulerAnglesOf(worldFromHand.rotation);
  refresh();
}

void PosePanel::showMass(const std::vector<const Part*>& parts, bool isLocked,
                         const std::optional<double>& total) {
  density_->setEnabled(!parts.empty() && !isLocked);
  showDensity(parts);
  double mass = 0.0;
  bool hasGeometry = false, isOfBox = false;
  for (const Part* part : parts) {
    if (part->geometry == nullptr) continue;
    hasGeometry = true;
    isOfBox = isOfBox || part->geometry->mass.basis == MassBasis::OrientedBox;
    mass += massOf(*part);
  }
  mass_->setText(hasGeometry ? formatMass(total.value_or(mass)) : QString());
  const bool isOne = parts.size() == 1;
  mass_->setToolTip(!isOfBox ? (isOne ? tr("Mass") : tr("Total mass of these parts"))
                    : isOne  ? tr("Mass of its bounding box, because the mesh encloses no volume")
                             : tr("Total mass; for a mesh that encloses no volume, of its bounding box"));
}

void PosePanel::showCentre(const std::optional<glm::dvec3>& inWorld) {
  centre_->setVisible(inWorld.has_value());
  if (!inWorld) return;
  constexpr int kDecimals = 3;
  const LengthUnit unit = shownLengthUnit();
  const auto length = [unit](double metres) {
    return lengthIn(unit, metres, kDecimals + extraDecimals(unit));
  };
  const auto number = [&](double metres) { return length(metres).section(QChar(' '), 0, 0); };
  const QString text =
      tr("Centre of mass %1, %2, %3").arg(number(inWorld->x), number(inWorld->y), length(inWorld->z));
  if (text == centre_->text()) return;
  centre_->setText(text);
  centre_->setToolTip(text + QChar('\n') +
                      tr("Centre of mass of all visible parts of the group, in the world"));
}

void PosePanel::showJoints(const QString& text, const QString& help, bool canRemove, int wholeStart) {
  joints_->setText(text);
  joints_->setWholeStart(wholeStart);
  joints_->setToolTip(help);
  removeJoints_->setEnabled(canRemove);
  jointRow_->setVisible(!text.isEmpty());
}

void PosePanel::showDensity(const std::vector<const Part*>& parts) {
  if (parts.empty()) density_->takeBack();
  const double density = parts.empty() ? kDefaultDensity : parts.back()->density;
  const bool areSame = std::ranges::all_of(parts, [&](const Part* part) { return part->density == density; });
  areSame ? density_->showQuantity(density) : density_->showMixed(tr("different"));
}

double PosePanel::step() const {
  return step_->quantity();
}

double PosePanel::turnStep() const {
  return turnStep_->quantity();
}

void PosePanel::commit() {
  for (NumberField* field : fields_)
    field->settle();
  density_->settle();
}

void PosePanel::edit(int field) {
  const auto i = static_cast<std::size_t>(field);
  const double value = fields_[i]->quantity();
  double& number = field < 3 ? hand_.translation[field] : handAngles_[field - 3];
  const bool isOn = fields_[i]->isStepping();
  number = isOn ? number + (value - shown_[i]) : value;
  shown_[i] = value;
  if (field >= 3) turnTo(rotationFromEulerAngles(handAngles_));
  isEditing_ = true;
  emit poseEdited(hand_);
  isEditing_ = false;
}

void PosePanel::turnTo(const glm::dquat& rotation) {
  const glm::dvec3 pivot = pivotInPart_ ? pivotInPart_() : glm::dvec3(0.0);
  hand_ = {rotation, hand_.applyToPoint(pivot) - rotation * pivot};
}

void PosePanel::refresh() {
  const glm::dvec3 angles = eulerAnglesOf(pose_.rotation);
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double values[2] = {pose_.translation[axis], angles[axis]};
    for (const std::size_t kind : {0U, 1U}) {
      NumberField* field = fields_[i + 3 * kind];
      field->showQuantity(values[kind]);
      if (!field->isUnsettled()) shown_[i + 3 * kind] = field->value() * field->shownUnit();
    }
  }
}

}  // namespace nearfit::ui
