#include "ui/panels/feel/feel_pages.h"

#include <QCheckBox>
#include <QFormLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>

#include "core/haptics/workspace_mapper.h"
#include "core/math/euler_angles.h"
#include "core/scene/haptic_limits.h"
#include "ui/panels/feel/locks_page.h"
#include "ui/widgets/format.h"
#include "ui/widgets/names.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

const QStringList kAxes = {QStringLiteral("X"), QStringLiteral("Y"), QStringLiteral("Z")};

/// Returns a row of three fields, one for each axis, with their names before them.
QHBoxLayout* axisRow(const std::array<NumberField*, 3>& fields) {
  auto* row = new QHBoxLayout;
  row->setSpacing(4);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    row->addWidget(new QLabel(kAxes[static_cast<int>(axis)]));
    row->addWidget(fields[axis], 1);
    if (axis < 2) row->addSpacing(6);
  }
  return row;
}

}  // namespace

SpringPage::SpringPage(QWidget* parent) : FeelPage(parent) {
  const auto stiffness = [](HapticSettings& s) -> double& { return s.springs.stiffness; };
  const QString toolTip = tr("Stiffness of each spring");
  linear_ = addNumber({"stiffness", toolTip, tr(" N/m"), kMinStiffness, kMaxStiffness}, stiffness);
  printed_ =
      addNumber({"printedStiffness", toolTip, tr(" N/m²"), kMinStiffness, kMaxPrintedStiffness}, stiffness);
  NumberField* damping = addNumber({"damping", tr("Damping of each spring: resists approach, never pulls"),
                                    tr(" N·s/m"), kMinDamping, kMaxDamping},
                                   [](HapticSettings& s) -> double& { return s.springs.damping; });
  linearLabel_ = new QLabel(tr("Stiffness"), this);
  printedLabel_ = new QLabel(tr("Stiffness"), this);
  auto* form = new QFormLayout(this);
  form->addRow(linearLabel_, linear_);
  form->addRow(printedLabel_, printed_);
  form->addRow(tr("Damping"), damping);
  form->addRow(
      addSwitch(QStringLiteral("onePerArea"), tr("One spring for each area of contact"),
                tr("The facets of a curved contact give many minima. On: only the nearest one of each area "
                   "pushes, so that finer meshes feel alike. Off: every minimum pushes, as in the paper"),
                [](HapticSettings& s) -> bool& { return s.springs.onePerArea; }));
  limits_ = addNote();
  limits_->setObjectName(QStringLiteral("springLimits"));
  bound_ = addNote();
  bound_->setObjectName(QStringLiteral("springBound"));
  form->addRow(limits_);
  form->addRow(bound_);
}

void SpringPage::showBasis(const CouplingBasis& basis) {
  basis_ = basis;
  refresh();
}

void SpringPage::refresh() {
  const bool isLinear = settings().springs.law == SpringLaw::Linear;
  for (QWidget* widget : {static_cast<QWidget*>(linear_), static_cast<QWidget*>(linearLabel_)})
    widget->setVisible(isLinear);
  for (QWidget* widget : {static_cast<QWidget*>(printed_), static_cast<QWidget*>(printedLabel_)})
    widget->setVisible(!isLinear);
  const DeviceLimits& device = basis_.device;
  limits_->setText(tr("Device limits: at most %1 N and %2 N·m, changing by at most %3 N/s and %4 N·m/s. "
                      "Energy beyond what the hand has put in is damped.")
                       .arg(formatNumber(device.maxForce), formatNumber(device.maxTorque),
                            formatNumber(device.forceSlew), formatNumber(device.torqueSlew)));
  showBound();
}

void SpringPage::showBound() {
  const SpringParameters& springs = settings().springs;
  const DeviceLimits device = limitsAtHandle(basis_.device, settings().mapping.scale);
  const double count = std::max(basis_.springs.value_or(1), std::uint32_t{1});
  const double damping = std::min(count * springs.damping, kMaxDampingShare * device.damping);
  const double most = stiffnessBound(device.damping, damping, basis_.period);
  QString text = tr("Limit on the total stiffness of springs along one line: stable with any hand up to %1 "
                    "N/m, at a servo "
                    "period of %2 and a device damping of %3 N·s/m; turns have a limit of their own. What is "
                    "stiffer is held "
                    "back to it.")
                     .arg(formatNumber(most), formatDuration(basis_.period), formatNumber(device.damping));
  const bool isHeld = basis_.springs && basis_.shares.isHeld();
  if (isHeld) {
    text += tr(" Springs now: %1; felt of them: %2 %.")
                .arg(*basis_.springs)
                .arg(formatNumber(100.0 * basis_.shares.wrench));
  } else if (basis_.springs) {
    text += tr(" Springs now: %1, felt in full.").arg(*basis_.springs);
  }
  bound_->setText(text);
  const QString style =
      QStringLiteral("color: %1").arg((isHeld ? colours::kWarning : colours::kMutedText).name());
  // Runs sixty times a second: setting a style is expensive.
  if (bound_->styleSheet() != style) bound_->setStyleSheet(style);
}

WeightPage::WeightPage(QWidget* parent) : FeelPage(parent) {
  QCheckBox* weight = addSwitch(QStringLiteral("weight"), tr("Weight: feel the weight of the part"),
                                tr("Weight beyond what the device can hold is not felt"),
                                [](HapticSettings& s) -> bool& { return s.weight.hasWeight; });
  inertia_ = addSwitch(QStringLiteral("inertia"), tr("Inertia: the part resists acceleration"),
                       tr("Proxy mode only: with springs the part is where the hand is"),
                       [](HapticSettings& s) -> bool& { return s.weight.hasInertia; });
  std::array<NumberField*, 3> gravity{};
  const char* names[3] = {"gravityX", "gravityY", "gravityZ"};
  for (int axis = 0; axis < 3; ++axis) {
    gravity[static_cast<std::size_t>(axis)] =
        addNumber({names[axis],
                   tr("Gravity along the world's %1 axis; magnitude up to %2 m/s²")
                       .arg(kAxes[axis], formatNumber(kMaxGravity)),
                   {},
                   -kMaxGravity,
                   kMaxGravity,
                   5},
                  [axis](HapticSettings& s) -> double& { return s.weight.gravity[axis]; });
  }
  mass_ = addNote();
  auto* layout = new QVBoxLayout(this);
  layout->addWidget(weight);
  layout->addWidget(inertia_);
  layout->addSpacing(6);
  layout->addWidget(new QLabel(tr("Gravity [m/s²]"), this));
  layout->addLayout(axisRow(gravity));
  layout->addSpacing(6);
  layout->addWidget(mass_);
  layout->addStretch(1);
}

void WeightPage::refresh() {
  inertia_->setEnabled(settings().mode == HapticMode::Proxy);
}

void WeightPage::showMass(const QString& name, double mass) {
  mass_->setText(name.isEmpty() ? tr("No part is in hand.")
                                : tr("%1 has a mass of %2. Set its density under Pose and mass.")
                                      .arg(breakable(shortName(name)), formatMass(mass)));
}

WorkspacePage::WorkspacePage(QWidget* parent) : FeelPage(parent) {
  NumberField* scale =
      addNumber({"scale", tr("Metres in the scene per metre of the device"), tr(" ×"), kMinScale, kMaxScale},
                [](HapticSettings& s) -> double& { return s.mapping.scale; });
  makeAngles();
  locks_ = new LocksPage({}, this);
  connect(locks_, &FeelPage::edited, this, &WorkspacePage::change);
  QLabel* note = addNote();
  note->setText(tr("Scale and orientation don't affect the manual hand; axis locks do."));
  auto* scaleRow = new QFormLayout;
  scaleRow->addRow(tr("Scale"), scale);
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(scaleRow);
  layout->addWidget(new QLabel(tr("Orientation of the device"), this));
  layout->addLayout(axisRow(angleFields_));
  layout->addSpacing(6);
  layout->addWidget(new QLabel(tr("Allowed motion"), this));
  layout->addWidget(locks_);
  layout->addSpacing(6);
  layout->addWidget(note);
  layout->addStretch(1);
}

void WorkspacePage::makeAngles() {
  const char* names[3] = {"orientationX", "orientationY", "orientationZ"};
  for (int axis = 0; axis < 3; ++axis) {
    auto* field = new NumberField(this);
    field->setObjectName(QLatin1String(names[axis]));
    field->setTrimmed(true);
    field->setActingAtOnce();
    field->setRange(-360.0, 360.0);
    field->setUnit(QString(QChar(0xB0)));
    field->setToolTip(
        tr("Rotation from the device's frame to the world frame, about fixed X, Y, Z in this order"));
    connect(field, &NumberField::quantityEdited, this, [this, axis](double angle) { turn(axis, angle); });
    angleFields_[static_cast<std::size_t>(axis)] = field;
  }
}

void WorkspacePage::turn(int axis, double angle) {
  angles_[axis] = angle;
  HapticSettings next = settings();
  next.mapping.orientationOffset = rotationFromEulerAngles(angles_);
  change(next);
}

void WorkspacePage::refresh() {
  locks_->showSettings(settings());
  // Typed angles stay, even if others give the same rotation.
  if (rotationFromEulerAngles(angles_) != settings().mapping.orientationOffset)
    angles_ = eulerAnglesOf(settings().mapping.orientationOffset);
  for (int axis = 0; axis < 3; ++axis) {
    NumberField* field = angleFields_[static_cast<std::size_t>(axis)];
    field->showQuantity(angles_[axis]);
  }
}

}  // namespace nearfit::ui
