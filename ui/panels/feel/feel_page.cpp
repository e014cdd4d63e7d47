#include "ui/panels/feel/feel_page.h"

#include <QCheckBox>
#include <QLabel>
#include <QSignalBlocker>

#include "ui/widgets/format.h"
#include "ui/widgets/number_field.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {

void FeelPage::showSettings(const HapticSettings& settings) {
  if (hasShown_ && settings == settings_) return;
  hasShown_ = true;
  settings_ = settings;
  for (const auto& show : showers_)
    show();
  refresh();
}

void FeelPage::change(const HapticSettings& next) {
  settings_ = next;
  refresh();
  emit edited(next);
}

void FeelPage::replace(const HapticSettings& next) {
  showSettings(next);
  emit edited(next);
}

NumberField* FeelPage::addNumber(const Number& number, const NumberOf& valueOf) {
  auto* field = new NumberField(this);
  field->setObjectName(QLatin1String(number.name));
  field->setTrimmed(true);
  field->setActingAtOnce();
  field->setDecimals(number.decimals);
  number.isLength ? field->setLength(number.decimals) : field->setUnit(number.unit);
  field->setQuantityRange(number.lower, number.upper);
  field->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
  field->setHelp(number.toolTip);
  connect(field, &NumberField::quantityEdited, this, [=, this](double value) {
    HapticSettings next = settings_;
    valueOf(next) = value;
    change(next);
  });
  showers_.emplace_back([=, this] { field->showQuantity(valueOf(settings_)); });
  return field;
}

QCheckBox* FeelPage::addSwitch(const QString& name, const QString& text, const QString& toolTip,
                               const SwitchOf& valueOf) {
  auto* box = new QCheckBox(text, this);
  box->setObjectName(name);
  box->setToolTip(toolTip);
  connect(box, &QCheckBox::toggled, this, [=, this](bool isOn) {
    HapticSettings next = settings_;
    valueOf(next) = isOn;
    change(next);
  });
  showers_.emplace_back([=, this] {
    const QSignalBlocker blocker(box);
    box->setChecked(valueOf(settings_));
  });
  return box;
}

QLabel* FeelPage::addNote() {
  auto* note = new QLabel(this);
  note->setWordWrap(true);
  note->setStyleSheet(QStringLiteral("color: %1").arg(colours::kMutedText.name()));
  return note;
}

}  // namespace nearfit::ui
