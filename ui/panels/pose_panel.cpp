#include "ui/panels/pose_panel.h"

#include <QDoubleSpinBox>
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
  const QStringList axes = {QStringLiteral("X"), QStringLiteral("Y"), QStringLiteral("Z")};
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    fields_[i] = makeField(QStringLiteral("position") + axes[axis], kMaxPosition, 4, tr(" mm"), 1.0);
    fields_[i + 3] = makeField(QStringLiteral("rotation") + axes[axis], 360.0, 3, QString(QChar(0xB0)), 1.0);
    layout->addWidget(new QLabel(axes[axis], this), axis + 1, 0);
    layout->addWidget(fields_[i], axis + 1, 1);
    layout->addWidget(new QLabel(QStringLiteral("R") + axes[axis].toLower(), this), axis + 1, 2);
    layout->addWidget(fields_[i + 3], axis + 1, 3);
  }
  step_ = makeField(QStringLiteral("nudgeStep"), 1e4, 3, tr(" mm"), 0.1);
  step_->setMinimum(1e-3);
  step_->setValue(0.1);
  step_->setToolTip(tr("How far the arrow and page keys move the part while the 3-D view has the focus"));
  layout->addWidget(new QLabel(tr("Key step"), this), 4, 0, 1, 3, Qt::AlignRight | Qt::AlignVCenter);
  layout->addWidget(step_, 4, 3);
  layout->setColumnStretch(1, 3);
  layout->setColumnStretch(3, 2);
  layout->setRowStretch(5, 1);
  for (int field = 0; field < 6; ++field) {
    connect(fields_[static_cast<std::size_t>(field)], QOverload<double>::of(&QDoubleSpinBox::valueChanged),
            this, [this, field] { edit(field); });
  }
  showPart({}, false);
}

QDoubleSpinBox* PosePanel::makeField(const QString& name, double limit, int decimals, const QString& suffix,
                                     double step) {
  auto* field = new QDoubleSpinBox(this);
  field->setObjectName(name);
  field->setRange(-limit, limit);
  field->setDecimals(decimals);
  field->setSuffix(suffix);
  field->setSingleStep(step);
  field->setKeyboardTracking(false);
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
  for (QDoubleSpinBox* field : fields_)
    field->setEnabled(isEditable);
  if (name.isEmpty()) showPose({});
}

void PosePanel::showPose(const RigidTransform& worldFromPart) {
  pose_ = worldFromPart;
  angles_ = eulerAnglesOf(worldFromPart.rotation);
  refresh();
}

double PosePanel::step() const {
  return step_->value() / kMillimetresPerMetre;
}

void PosePanel::commit() {
  for (QDoubleSpinBox* field : fields_) {
    if (field->findChild<QLineEdit*>()->isModified()) field->interpretText();
  }
}

void PosePanel::edit(int field) {
  const double value = fields_[static_cast<std::size_t>(field)]->value();
  if (field < 3) {
    pose_.translation[field] = value / kMillimetresPerMetre;
  } else {
    angles_[field - 3] = value / kDegreesPerRadian;
    pose_.rotation = rotationFromEulerAngles(angles_);
  }
  emit poseEdited(pose_);
}

void PosePanel::refresh() {
  for (int axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const double values[2] = {pose_.translation[axis] * kMillimetresPerMetre,
                              angles_[axis] * kDegreesPerRadian};
    for (const std::size_t kind : {0U, 1U}) {
      QDoubleSpinBox* field = fields_[i + 3 * kind];
      // A field that is being typed in is left alone.
      if (field->hasFocus() && field->findChild<QLineEdit*>()->isModified()) continue;
      const QSignalBlocker blocker(field);
      // Plus zero: no "-0".
      field->setValue(values[kind] + 0.0);
    }
  }
}

}  // namespace nearfit::ui
