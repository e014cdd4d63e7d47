#include "ui/dialogs/spring_dialog.h"

#include <QComboBox>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "core/scene/haptic_limits.h"
#include "ui/theme.h"

namespace nearfit::ui {
namespace {

constexpr double kMillimetresPerMetre = 1e3;

}  // namespace

SpringDialog::SpringDialog(QWidget* parent) : QDialog(parent) {
  setObjectName(QStringLiteral("springDialog"));
  setWindowTitle(tr("Springs"));
  cutoff_ = makeField(QStringLiteral("cutoff"), 4);
  cutoff_->setRange(kMinCutoff * kMillimetresPerMetre, kMaxCutoff * kMillimetresPerMetre);
  cutoff_->setSuffix(tr(" mm"));
  cutoff_->setToolTip(tr("Parts feel each other from this distance on; also the springs' rest length"));
  stiffness_ = makeField(QStringLiteral("stiffness"), 2);
  stiffness_->setRange(kMinStiffness, kMaxStiffness);
  stiffness_->setToolTip(tr("How hard each spring pushes for a given compression"));
  damping_ = makeField(QStringLiteral("damping"), 3);
  damping_->setRange(kMinDamping, kMaxDamping);
  damping_->setSuffix(tr(" N·s/m"));
  damping_->setToolTip(tr("Resistance to approach along each minimum; never pulls"));
  law_ = new QComboBox(this);
  law_->setObjectName(QStringLiteral("law"));
  law_->addItem(tr("Linear"), static_cast<int>(SpringLaw::Linear));
  law_->addItem(tr("As printed in the paper"), static_cast<int>(SpringLaw::Printed));
  explanation_ = new QLabel(this);
  explanation_->setWordWrap(true);
  explanation_->setMinimumHeight(48);
  explanation_->setAlignment(Qt::AlignLeft | Qt::AlignTop);
  explanation_->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));

  auto* form = new QFormLayout;
  form->addRow(tr("Cutoff"), cutoff_);
  form->addRow(tr("Stiffness"), stiffness_);
  form->addRow(tr("Damping"), damping_);
  form->addRow(tr("Law"), law_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close, this);
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::close);
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(form);
  layout->addWidget(explanation_);
  layout->addWidget(buttons);
  setMinimumWidth(340);

  for (QDoubleSpinBox* field : {cutoff_, stiffness_, damping_}) {
    connect(field, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this, &SpringDialog::edit);
  }
  connect(law_, QOverload<int>::of(&QComboBox::activated), this, &SpringDialog::edit);
  showSprings({});
}

QDoubleSpinBox* SpringDialog::makeField(const QString& name, int decimals) {
  auto* field = new QDoubleSpinBox(this);
  field->setObjectName(name);
  field->setDecimals(decimals);
  field->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
  field->setKeyboardTracking(false);
  field->setMinimumWidth(170);
  return field;
}

void SpringDialog::showSprings(const SpringParameters& springs) {
  springs_ = springs;
  const QSignalBlocker blockers[] = {QSignalBlocker(cutoff_), QSignalBlocker(stiffness_),
                                     QSignalBlocker(damping_)};
  cutoff_->setValue(springs.cutoff * kMillimetresPerMetre);
  stiffness_->setValue(springs.stiffness);
  damping_->setValue(springs.damping);
  law_->setCurrentIndex(law_->findData(static_cast<int>(springs.law)));
  explainLaw();
}

void SpringDialog::edit() {
  // Only the field that was changed: the others may be rounded for display.
  SpringParameters next = springs_;
  const QObject* field = sender();
  if (field == cutoff_) next.cutoff = cutoff_->value() / kMillimetresPerMetre;
  if (field == stiffness_) next.stiffness = stiffness_->value();
  if (field == damping_) next.damping = damping_->value();
  if (field == law_) next.law = static_cast<SpringLaw>(law_->currentData().toInt());
  springs_ = next;
  explainLaw();
  emit springsEdited(next);
}

void SpringDialog::explainLaw() {
  const bool isLinear = springs_.law == SpringLaw::Linear;
  stiffness_->setSuffix(isLinear ? tr(" N/m") : tr(" N/m²"));
  explanation_->setText(
      isLinear ? tr("Each minimum pushes with stiffness × (cutoff − distance): most at contact.")
               : tr("Each minimum pushes with stiffness × (cutoff − distance) × distance, as the "
                    "paper prints it: nothing at contact, most at half the cutoff."));
}

}  // namespace nearfit::ui
