#include "ui/number_field.h"

namespace nearfit::ui {

NumberField::NumberField(QWidget* parent) : QDoubleSpinBox(parent) {
  setKeyboardTracking(false);
}

void NumberField::setTrimmed(bool isTrimmed) {
  isTrimmed_ = isTrimmed;
  setValue(value());
}

QString NumberField::textFromValue(double value) const {
  QString text = QDoubleSpinBox::textFromValue(value);
  if (!isTrimmed_ || !text.contains(locale().decimalPoint())) return text;
  while (text.endsWith(locale().zeroDigit()))
    text.chop(1);
  if (text.endsWith(locale().decimalPoint())) text.chop(1);
  return text;
}

void NumberField::stepBy(int steps) {
  isStepping_ = true;
  QDoubleSpinBox::stepBy(steps);
  isStepping_ = false;
}

}  // namespace nearfit::ui
