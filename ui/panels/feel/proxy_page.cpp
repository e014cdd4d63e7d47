#include "ui/panels/feel/proxy_page.h"

#include <QCheckBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QGroupBox>
#include <QLabel>
#include <QVBoxLayout>
#include <algorithm>

#include "core/haptics/workspace_mapper.h"
#include "core/scene/haptic_limits.h"
#include "ui/widgets/font_scale.h"
#include "ui/widgets/format.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Shows the limit of a number, or in the warning colour what a wish is limited to.
void showMost(QLabel& note, double most, double wished, double limited, const QString& unit,
              bool isAutomatic) {
  const bool isHeld = !isAutomatic && limited < wished;
  note.setText(isHeld ? QObject::tr("limited to %1%2").arg(formatNumber(limited), unit)
                      : QObject::tr("at most %1%2").arg(formatNumber(most), unit));
  const QString style =
      QStringLiteral("color: %1").arg((isHeld ? colours::kWarning : colours::kMutedText).name());
  // Runs sixty times a second: setting a style is expensive.
  if (note.styleSheet() != style) note.setStyleSheet(style);
}

}  // namespace

ProxyPage::ProxyPage(QWidget* parent) : FeelPage(parent) {
  NumberField* margin =
      addNumber({"margin",
                 tr("Gap that the part keeps in contact; at most the cutoff. A smaller margin shows the true "
                    "gap better; a larger one lets the part slide faster."),
                 {},
                 kMinMargin,
                 kMaxMargin,
                 6,
                 true},
                [](HapticSettings& s) -> double& { return s.proxy.margin; });
  NumberField* friction =
      addNumber({"friction",
                 tr("Coefficient of Coulomb friction: 0 is none, dry steel has about 0.15"),
                 {},
                 kMinFriction,
                 kMaxFriction},
                [](HapticSettings& s) -> double& { return s.proxy.friction; });
  auto* form = new QFormLayout;
  form->addRow(tr("Margin"), margin);
  form->addRow(tr("Friction"), friction);
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(form);
  layout->addWidget(makeCoupling());
}

QWidget* ProxyPage::makeCoupling() {
  automatic_ = addSwitch(QStringLiteral("automaticCoupling"), tr("As stiff as the device allows"),
                         tr("Chosen from the device's damping and the measured period of the servo"),
                         [](HapticSettings& s) -> bool& { return s.coupling.isAutomatic; });
  makeRows();
  reason_ = addNote();
  reason_->setObjectName(QStringLiteral("boundReason"));

  auto* group = new QGroupBox(tr("Coupling between hand and part"), this);
  auto* grid = new QGridLayout;
  grid->setVerticalSpacing(2);
  grid->addWidget(new QLabel(tr("Stiffness"), this), 0, 1);
  grid->addWidget(new QLabel(tr("Damping"), this), 0, 2);
  const QString names[2] = {tr("Translation"), tr("Rotation")};
  for (int i = 0; i < 2; ++i) {
    const Row& row = rows_[static_cast<std::size_t>(i)];
    grid->addWidget(new QLabel(names[i], this), 1 + 2 * i, 0);
    grid->addWidget(row.stiffness, 1 + 2 * i, 1);
    grid->addWidget(row.damping, 1 + 2 * i, 2);
    grid->addWidget(row.stiffnessNote, 2 + 2 * i, 1);
    grid->addWidget(row.dampingNote, 2 + 2 * i, 2);
  }
  grid->setColumnStretch(1, 1);
  grid->setColumnStretch(2, 1);
  auto* layout = new QVBoxLayout(group);
  layout->addWidget(automatic_);
  layout->addLayout(grid);
  layout->addWidget(reason_);
  return group;
}

void ProxyPage::makeRows() {
  rows_[0] = addRow(
      {"couplingStiffness", tr("Stiffness of the coupling between hand and part"), tr(" N/m"), kMinStiffness,
       kMaxStiffness, 2},
      [](HapticSettings& s) -> double& { return s.coupling.stiffness; },
      {"couplingDamping", tr("Damping of the coupling between hand and part"), tr(" N·s/m"), kMinDamping,
       kMaxDamping, 4},
      [](HapticSettings& s) -> double& { return s.coupling.damping; });
  rows_[1] = addRow(
      {"rotationalStiffness", tr("About the part's axis of max inertia"), tr(" N·m/rad"),
       kMinRotationalStiffness, kMaxRotationalStiffness, 5},
      [](HapticSettings& s) -> double& { return s.coupling.rotationalStiffness; },
      {"rotationalDamping", tr("About the part's axis of max inertia"), tr(" N·m·s/rad"),
       kMinRotationalDamping, kMaxRotationalDamping, 8},
      [](HapticSettings& s) -> double& { return s.coupling.rotationalDamping; });
}

ProxyPage::Row ProxyPage::addRow(const Number& stiffness, const NumberOf& stiffnessOf, const Number& damping,
                                 const NumberOf& dampingOf) {
  Row row{addNumber(stiffness, stiffnessOf),
          addNumber(damping, dampingOf),
          new QLabel(this),
          new QLabel(this),
          stiffness.unit,
          damping.unit};
  row.stiffnessNote->setObjectName(QLatin1String(stiffness.name) + QStringLiteral("Note"));
  row.dampingNote->setObjectName(QLatin1String(damping.name) + QStringLiteral("Note"));
  for (NumberField* field : {row.stiffness, row.damping})
    field->setMinimumWidth(forFont(*field, 130));
  return row;
}

void ProxyPage::showBasis(const CouplingBasis& basis) {
  basis_ = basis;
  wishedThen_ = settings().coupling;
  refresh();
}

void ProxyPage::refresh() {
  const CouplingSettings& wish = settings().coupling;
  const DeviceLimits device = limitsAtHandle(basis_.device, settings().mapping.scale);
  // The tick shown may be older than the wish; then its stiffness is no limit.
  const CouplingState state = wish.isAutomatic && basis_.inForce && wishedThen_ == wish
                                  ? *basis_.inForce
                                  : boundedCoupling(wish, device, basis_.metric, basis_.period);
  showRow(rows_[0],
          {state.stiffness, state.damping, stiffnessBound(device.damping, state.damping, basis_.period),
           kMaxDampingShare * device.damping, wish.stiffness, wish.damping});
  showRow(rows_[1],
          {state.rotationalStiffness, state.rotationalDamping,
           stiffnessBound(device.rotationalDamping, state.rotationalDamping, basis_.period),
           kMaxDampingShare * device.rotationalDamping, wish.rotationalStiffness, wish.rotationalDamping});
  const QString period = basis_.inForce ? tr("Stability limit at the measured %1 servo period,")
                                        : tr("Stability limit at a servo period of %1,");
  reason_->setText((period + QChar(' ') + tr("with the device's damping of %2 N·s/m and %3 N·m·s/rad."))
                       .arg(formatDuration(basis_.period), formatNumber(device.damping),
                            formatNumber(device.rotationalDamping)));
}

void ProxyPage::showRow(const Row& row, const Line& line) {
  const bool isAutomatic = settings().coupling.isAutomatic;
  for (NumberField* field : {row.stiffness, row.damping}) {
    field->setEnabled(!isAutomatic);
    // Greyed fields show what is in force; the wish comes back when they are used.
    if (field->hasFocus() && !isAutomatic) continue;
    const bool isStiffness = field == row.stiffness;
    const double wished = isStiffness ? line.wishedStiffness : line.wishedDamping;
    const double inForce = isStiffness ? line.stiffness : line.damping;
    field->showQuantity(isAutomatic ? inForce : wished);
  }
  showMost(*row.stiffnessNote, line.mostStiffness, line.wishedStiffness, line.stiffness, row.stiffnessUnit,
           isAutomatic);
  showMost(*row.dampingNote, line.mostDamping, line.wishedDamping, line.damping, row.dampingUnit,
           isAutomatic);
}

}  // namespace nearfit::ui
