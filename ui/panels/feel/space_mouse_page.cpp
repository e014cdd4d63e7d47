#include "ui/panels/feel/space_mouse_page.h"

#include <QCheckBox>
#include <QFormLayout>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QVBoxLayout>

#include "ui/panels/feel/feel_page.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

const QStringList kMotions = {QStringLiteral("X"),  QStringLiteral("Y"),  QStringLiteral("Z"),
                              QStringLiteral("Rx"), QStringLiteral("Ry"), QStringLiteral("Rz")};

}  // namespace

SpaceMousePage::SpaceMousePage(QWidget* parent) : QWidget(parent) {
  auto* form = new QFormLayout;
  form->addRow(tr("Dead zone"),
               addNumber({"rateDeadZone", tr("Share of the cap's travel in which nothing moves"), tr(" %"),
                          0.0, kMaxDeadZone, &RateSettings::deadZone}));
  form->addRow(tr("Curve"), addNumber({"rateCurve",
                                       tr("1 is linear; larger values are finer for small pushes"),
                                       {},
                                       kMinExponent,
                                       kMaxExponent,
                                       &RateSettings::exponent}));
  form->addRow(
      tr("Speed"),
      addNumber({"rateSpeed", tr("Speed with the cap pushed all the way, before the workspace scale"),
                 tr(" mm/s"), 0.0, kMaxFullSpeed, &RateSettings::fullSpeed}));
  form->addRow(tr("Rotation"), addNumber({"rateTurn", tr("Rotation speed with the cap turned all the way"),
                                          tr(" °/s"), 0.0, kMaxFullTurn, &RateSettings::fullTurn}));
  auto* note = new QLabel(tr("First button: hold it to keep the part still. Second button: return the hand "
                             "to the part. These settings apply to all scenes."),
                          this);
  note->setWordWrap(true);
  note->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  auto* usual = new QPushButton(tr("Restore defaults"), this);
  usual->setObjectName(QStringLiteral("rateUsual"));
  usual->setAutoDefault(false);
  connect(usual, &QPushButton::clicked, this, [this] {
    showSettings({});
    emit edited(settings_);
  });
  auto* layout = new QVBoxLayout(this);
  layout->addLayout(form);
  layout->addSpacing(6);
  layout->addLayout(makeAxes());
  layout->addSpacing(6);
  layout->addWidget(note);
  layout->addStretch(1);
  layout->addWidget(usual, 0, Qt::AlignLeft);
  showSettings({});
}

void SpaceMousePage::showSettings(const RateSettings& settings) {
  settings_ = settings;
  for (const auto& show : showers_)
    show();
}

void SpaceMousePage::change(const RateSettings& settings) {
  settings_ = settings;
  emit edited(settings);
}

NumberField* SpaceMousePage::addNumber(const Number& number) {
  auto* field = new NumberField(this);
  field->setObjectName(QLatin1String(number.name));
  field->setTrimmed(true);
  field->setActingAtOnce();
  field->setUnit(number.unit);
  field->setQuantityRange(number.lower, number.upper);
  field->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
  field->setHelp(number.toolTip);
  connect(field, &NumberField::quantityEdited, this, [this, value = number.value](double quantity) {
    RateSettings next = settings_;
    next.*value = quantity;
    change(next);
  });
  showers_.emplace_back([this, field, value = number.value] { field->showQuantity(settings_.*value); });
  return field;
}

QCheckBox* SpaceMousePage::addSwitch(const QString& name, const QString& toolTip,
                                     std::array<bool, 6> RateSettings::* values, std::size_t axis) {
  auto* box = new QCheckBox(this);
  box->setObjectName(name);
  box->setToolTip(toolTip);
  connect(box, &QCheckBox::toggled, this, [=, this](bool isOn) {
    RateSettings next = settings_;
    (next.*values)[axis] = isOn;
    change(next);
  });
  showers_.emplace_back([=, this] {
    const QSignalBlocker blocker(box);
    box->setChecked((settings_.*values)[axis]);
  });
  return box;
}

QGridLayout* SpaceMousePage::makeAxes() {
  auto* grid = new QGridLayout;
  grid->setHorizontalSpacing(12);
  grid->addWidget(new QLabel(tr("On"), this), 1, 0);
  grid->addWidget(new QLabel(tr("Reversed"), this), 2, 0);
  for (int column = 0; column < kMotions.size(); ++column) {
    const QString& axis = kMotions[column];
    const auto i = static_cast<std::size_t>(column);
    grid->addWidget(new QLabel(axis, this), 0, column + 1);
    grid->addWidget(
        addSwitch(QStringLiteral("rateOn") + axis, tr("The cap moves the part along or about this axis"),
                  &RateSettings::isEnabled, i),
        1, column + 1);
    grid->addWidget(addSwitch(QStringLiteral("rateReversed") + axis, tr("Reverse the direction"),
                              &RateSettings::isInverted, i),
                    2, column + 1);
  }
  grid->setColumnStretch(static_cast<int>(kMotions.size()) + 1, 1);
  return grid;
}

}  // namespace nearfit::ui
