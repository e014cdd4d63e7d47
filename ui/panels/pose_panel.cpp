#include "ui/panels/pose_panel.h"

#include <QEvent>
#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QSignalBlocker>
#include <algorithm>
#include <iterator>
#include <numbers>

#include "core/math/euler_angles.h"
#include "core/scene/scene.h"
#include "ui/format.h"
#include "ui/number_field.h"
#include "ui/theme.h"

namespace nearfit::ui {
namespace {

constexpr double kMillimetresPerMetre = 1e3;
constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;
constexpr double kMaxPosition = 1e7;  ///< [mm]

/// Whether a key is one of the window's commands, such as Ctrl+S, that a line editor has no use for here. It
/// claims some of them all the same: Ctrl+E to go to the end of the line, Ctrl+D to delete.
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

PosePanel::PosePanel(QWidget* parent) : QWidget(parent), heading_(new QLabel(this)) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(10, 8, 10, 10);
  layout->setHorizontalSpacing(6);
  layout->addWidget(heading_, 0, 0, 1, 4);
  setUpPose(*layout);
  setUpMass(*layout);
  layout->setColumnStretch(1, 3);
  layout->setColumnStretch(3, 2);
  layout->setRowStretch(6, 1);
  showPart({}, false);
  showMass(nullptr);
}

void PosePanel::setUpPose(QGridLayout& layout) {
  const QStringList axes = {QStringLiteral("X"), QStringLiteral("Y"), QStringLiteral("Z")};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    fields_[i] = makeField(QStringLiteral("position") + axes[axis], kMaxPosition, 4, tr(" mm"), 1.0);
    fields_[i + 3] = makeField(QStringLiteral("rotation") + axes[axis], 360.0, 3, QString(QChar(0xB0)), 1.0);
    layout.addWidget(new QLabel(axes[axis], this), axis + 1, 0);
    layout.addWidget(fields_[i], axis + 1, 1);
    layout.addWidget(new QLabel(QStringLiteral("R") + axes[axis].toLower(), this), axis + 1, 2);
    layout.addWidget(fields_[i + 3], axis + 1, 3);
  }
  step_ = makeField(QStringLiteral("nudgeStep"), 1e4, 3, tr(" mm"), 0.1);
  step_->setMinimum(1e-3);
  step_->setValue(0.1);
  step_->setToolTip(tr("How far the arrow and page keys move the part while the 3-D view has the focus"));
  layout.addWidget(new QLabel(tr("Key step"), this), 4, 0, 1, 3, Qt::AlignRight | Qt::AlignVCenter);
  layout.addWidget(step_, 4, 3);
  for (int field = 0; field < 6; ++field) {
    connect(fields_[static_cast<std::size_t>(field)], QOverload<double>::of(&QDoubleSpinBox::valueChanged),
            this, [this, field] { edit(field); });
  }
}

void PosePanel::setUpMass(QGridLayout& layout) {
  density_ = makeField(QStringLiteral("density"), kMaxDensity, 3, tr(" kg/m³"), 1.0);
  density_->setMinimum(kMinDensity);
  density_->setTrimmed(true);
  density_->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
  density_->setToolTip(
      tr("Of what the part is made: water 1000, aluminium 2700, steel 7850 kg/m³; from %1 to %2")
          .arg(formatNumber(kMinDensity), formatNumber(kMaxDensity)));
  mass_ = new QLabel(this);
  mass_->setObjectName(QStringLiteral("mass"));
  mass_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  auto* row = new QHBoxLayout;
  row->addWidget(new QLabel(tr("Density"), this));
  row->addWidget(density_, 1);
  row->addWidget(mass_);
  layout.addLayout(row, 5, 0, 1, 4);
  connect(density_, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, &PosePanel::densityEdited);
}

NumberField* PosePanel::makeField(const QString& name, double limit, int decimals, const QString& suffix,
                                  double step) {
  auto* field = new NumberField(this);
  field->setObjectName(name);
  field->setRange(-limit, limit);
  field->setDecimals(decimals);
  field->setSuffix(suffix);
  field->setSingleStep(step);
  field->setMinimumWidth(60);
  field->setAccelerated(true);
  field->findChild<QLineEdit*>()->installEventFilter(this);
  field->installEventFilter(this);
  return field;
}

bool PosePanel::eventFilter(QObject* watched, QEvent* event) {
  // A line editor claims the undo keys even when it has nothing to undo; then they are meant for the scene.
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

void PosePanel::showPart(const QString& name, bool isEditable) {
  heading_->setText(name.isEmpty() ? tr("No part selected") : name);
  heading_->setStyleSheet(name.isEmpty() ? QStringLiteral("color: %1").arg(colours::kMutedText.name())
                                         : QStringLiteral("font-weight: bold"));
  for (NumberField* field : fields_)
    field->setEnabled(isEditable);
  if (name.isEmpty()) showPose({});
}

void PosePanel::showPose(const RigidTransform& worldFromPart, const RigidTransform& worldFromHand) {
  pose_ = worldFromPart;
  hand_ = worldFromHand;
  handAngles_ = eulerAnglesOf(worldFromHand.rotation);
  refresh();
}

void PosePanel::showMass(const Part* part) {
  const bool hasGeometry = part != nullptr && part->geometry != nullptr;
  density_->setEnabled(part != nullptr && !part->isLocked);
  const bool isTyping = density_->hasFocus() && density_->findChild<QLineEdit*>()->isModified();
  if (!isTyping || part == nullptr) {
    const QSignalBlocker blocker(density_);
    density_->setValue(part != nullptr ? part->density : kDefaultDensity);
  }
  mass_->setText(hasGeometry ? formatMass(massOf(*part)) : QString());
  mass_->setToolTip(hasGeometry && part->geometry->mass.basis == MassBasis::OrientedBox
                        ? tr("Of its bounding box, as the mesh encloses no volume")
                        : tr("Mass"));
}

double PosePanel::step() const {
  return step_->value() / kMillimetresPerMetre;
}

void PosePanel::commit() {
  for (NumberField* field : fields_) {
    if (field->findChild<QLineEdit*>()->isModified()) field->interpretText();
  }
  if (density_->findChild<QLineEdit*>()->isModified()) density_->interpretText();
}

void PosePanel::edit(int field) {
  const auto i = static_cast<std::size_t>(field);
  const double value = fields_[i]->value();
  const double perUnit = field < 3 ? kMillimetresPerMetre : kDegreesPerRadian;
  double& number = field < 3 ? hand_.translation[field] : handAngles_[field - 3];
  const bool isOn = fields_[i]->isStepping();
  number = isOn ? number + (value - shown_[i]) / perUnit : value / perUnit;
  shown_[i] = value;
  if (field >= 3) hand_.rotation = rotationFromEulerAngles(handAngles_);
  emit poseEdited(hand_);
}

void PosePanel::refresh() {
  const glm::dvec3 angles = eulerAnglesOf(pose_.rotation);
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double values[2] = {pose_.translation[axis] * kMillimetresPerMetre,
                              angles[axis] * kDegreesPerRadian};
    for (const std::size_t kind : {0U, 1U}) {
      NumberField* field = fields_[i + 3 * kind];
      // A field that is being typed in is left alone.
      if (field->hasFocus() && field->findChild<QLineEdit*>()->isModified()) continue;
      const QSignalBlocker blocker(field);
      // Plus zero: no "-0".
      field->setValue(values[kind] + 0.0);
      shown_[i + 3 * kind] = field->value();
    }
  }
}

}  // namespace nearfit::ui
