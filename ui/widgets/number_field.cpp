#include "ui/widgets/number_field.h"

#include <QCoreApplication>
#include <QFocusEvent>
#include <QHelpEvent>
#include <QKeyEvent>
#include <QLineEdit>
#include <QMouseEvent>
#include <QSignalBlocker>
#include <QToolTip>
#include <algorithm>
#include <cmath>

#include "ui/widgets/fault_style.h"
#include "ui/widgets/format.h"
#include "ui/widgets/preferences.h"

namespace nearfit::ui {
namespace {

/// Digits that a field has room for before its unit. A unit that is cut is another one: "m" of "mm".
constexpr int kMaxDigits = 8;

/// Rounds a step to 1, 2 or 5 times a power of ten.
double roundStep(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  const double figure = step / power;
  return power * (figure < 1.5 ? 1.0 : figure < 3.5 ? 2.0 : figure < 7.5 ? 5.0 : 10.0);
}

}  // namespace

NumberField::NumberField(QWidget* parent) : QDoubleSpinBox(parent) {
  setKeyboardTracking(false);
  setAccelerated(true);
  connect(this, QOverload<double>::of(&QDoubleSpinBox::valueChanged), this,
          [this] { emit quantityEdited(quantity()); });
  connect(lineEdit(), &QLineEdit::textEdited, this, &NumberField::clearFault);
  lineEdit()->installEventFilter(this);
}

void NumberField::setUnit(const QString& unit) {
  Unit read;
  isReadable_ = true;
  try {
    read = unitNamed(unit.toStdString());
  } catch (const QuantityError&) {
    isReadable_ = false;
  }
  isLength_ = false;
  unit_ = read;
  applyUnit(unit, read.inSi);
}

void NumberField::setLength(int decimals) {
  isLength_ = true;
  isReadable_ = true;
  millimetreDecimals_ = decimals;
  unit_.dimension = {.length = 1};
  setLengthUnit(Preferences::lengthUnit());
}

void NumberField::setLengthUnit(LengthUnit unit) {
  if (!isLength_) return;
  const double before = quantity();
  const QSignalBlocker blocker(this);
  setDecimals(millimetreDecimals_ + extraDecimals(unit));
  applyUnit(QChar(' ') + symbolOf(unit), metresOf(unit));
  exact_ = before;
  setValue(before / unit_.inSi);
}

void NumberField::applyUnit(const QString& name, double inSi) {
  const QSignalBlocker blocker(this);
  unit_.inSi = inSi;
  unitText_ = name;
  if (lower_ != upper_) setRange(lower_ / inSi, upper_ / inSi);
  if (step_ > 0.0) setSingleStep(roundStep(step_ / inSi));
  if (!help_.isEmpty()) setHelp(help_);
  setValue(value());
}

void NumberField::setQuantityRange(double lower, double upper) {
  lower_ = lower;
  upper_ = upper;
  setRange(lower / unit_.inSi, upper / unit_.inSi);
}

void NumberField::setQuantityStep(double step) {
  step_ = step;
  setSingleStep(roundStep(step / unit_.inSi));
}

void NumberField::showMixed(const QString& word) {
  if (isUnsettled()) return;
  const QSignalBlocker blocker(this);
  // Qt shows this text in place of the minimum.
  setSpecialValueText(word);
  setValue(minimum());
  exact_ = lower_;
}

bool NumberField::isMixed() const {
  return !specialValueText().isEmpty() && value() == minimum();
}

void NumberField::showQuantity(double value) {
  if (isUnsettled()) return;
  const QSignalBlocker blocker(this);
  const bool isAllSelected =
      isEnabled() && lineEdit()->hasSelectedText() && lineEdit()->selectedText() == text();
  setSpecialValueText({});
  // Adding zero turns "-0" into "0".
  setValue(value / unit_.inSi + 0.0);
  exact_ = value;
  // Qt keeps the length of the selection and its cursor, which is less than all of a longer text.
  if (isAllSelected) selectAll();
}

double NumberField::quantity() const {
  const double half = 0.5000001 * std::pow(10.0, -decimals());
  const bool isSame = std::abs(exact_ / unit_.inSi - value()) <= half + 1e-15 * std::abs(value());
  return isSame ? exact_ : value() * unit_.inSi;
}

QString NumberField::limitsText() const {
  return tr("From %1 to %2%3").arg(formatNumber(minimum()), formatNumber(maximum()), unitText_);
}

void NumberField::setHelp(const QString& help) {
  help_ = help;
  setToolTip(help + QChar('\n') + limitsText());
}

void NumberField::setTrimmed(bool isTrimmed) {
  isTrimmed_ = isTrimmed;
  setValue(value());
}

bool NumberField::isUnsettled() const {
  return isFaulty() || (hasFocus() && lineEdit()->isModified());
}

void NumberField::settle() {
  if (!lineEdit()->isModified()) return;
  const Reading reading = read(lineEdit()->text());
  if (reading.fault.isEmpty()) {
    interpretText();
  } else {
    showFault(reading);
  }
}

void NumberField::takeBack() {
  clearFault();
  setValue(value());
  lineEdit()->setModified(false);
}

QString NumberField::textFromValue(double value) const {
  QString text = QDoubleSpinBox::textFromValue(value);
  const int signs = text.startsWith(locale().negativeSign()) ? 1 : 0;
  const int whole = text.indexOf(locale().decimalPoint()) - signs;
  if (!isTrimmed_ && whole + decimals() > kMaxDigits && whole > 1)
    text = formatFixed(value, std::clamp(kMaxDigits - whole, 1, decimals()));
  if (isTrimmed_ && text.contains(locale().decimalPoint())) {
    while (text.endsWith(locale().zeroDigit()))
      text.chop(1);
    if (text.endsWith(locale().decimalPoint())) text.chop(1);
  }
  return text + unitText_;
}

NumberField::Reading NumberField::read(const QString& text) const {
  QString number = text;
  for (const QString& sign : {suffix(), isReadable_ ? QString() : unitText_.trimmed()}) {
    if (!sign.isEmpty() && number.endsWith(sign)) number.chop(sign.size());
  }
  const QByteArray bytes = number.toUtf8();
  Reading reading;
  try {
    const std::string_view view(bytes.constData(), static_cast<std::size_t>(bytes.size()));
    reading.quantity = editedQuantity(view, unit_, quantity());
  } catch (const QuantityError& error) {
    reading.position = QString::fromUtf8(bytes.left(static_cast<int>(error.position()))).size();
    reading.fault = tr("Character %1: %2.\nTo fix it, %3.")
                        .arg(reading.position + 1)
                        .arg(QString::fromStdString(error.problem()), QString::fromStdString(error.remedy()));
    return reading;
  }
  const double shown = reading.quantity / unit_.inSi, rounding = 1e-12 * std::abs(shown);
  if (shown < minimum() - rounding || shown > maximum() + rounding) {
    reading.fault = tr("%1%2 is out of range.\n%3.").arg(formatNumber(shown), unitText_, limitsText());
  }
  return reading;
}

double NumberField::valueFromText(const QString& text) const {
  // Return on an untouched number does not round it to what is shown.
  if (text == textFromValue(value())) return value();
  const Reading reading = read(text);
  if (!reading.fault.isEmpty()) return value();
  exact_ = reading.quantity;
  return reading.quantity / unit_.inSi;
}

QValidator::State NumberField::validate(QString& text, int& /*position*/) const {
  // Never Invalid: an unfinished text must not be refused while it is typed.
  return read(text).fault.isEmpty() ? QValidator::Acceptable : QValidator::Intermediate;
}

void NumberField::stepBy(int steps) {
  settle();
  if (isFaulty() || isMixed()) return;
  isStepping_ = true;
  QDoubleSpinBox::stepBy(steps);
  isStepping_ = false;
}

bool NumberField::event(QEvent* event) {
  if (event->type() != QEvent::ToolTip) return QDoubleSpinBox::event(event);
  const QString help =
      tr("Takes units and arithmetic: 12.5 mm, 1/4 in, 2*(3 + 0,5), 90 deg.\n"
         "+= 5 adds 5 to the current value; -=, *= and /= work the same way.");
  QStringList text;
  if (!toolTip().isEmpty()) text << toolTip();
  // Useless while nothing can be typed.
  if (isEnabled()) text << help;
  QToolTip::showText(static_cast<QHelpEvent*>(event)->globalPos(),
                     isFaulty() ? fault_ : text.join(QChar('\n')), this);
  return true;
}

bool NumberField::eventFilter(QObject* watched, QEvent* event) {
  const bool isDoubleClick = watched == lineEdit() && event->type() == QEvent::MouseButtonDblClick;
  if (!isDoubleClick || static_cast<QMouseEvent*>(event)->button() != Qt::LeftButton)
    return QDoubleSpinBox::eventFilter(watched, event);
  // A line editor would select a word, which ends at the decimal point.
  selectAll();
  return true;
}

void NumberField::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape && (isFaulty() || lineEdit()->isModified())) {
    takeBack();
    selectAll();
    event->accept();
    return;
  }
  const bool isUntouched = isMixed() && !lineEdit()->isModified();
  if (!isUntouched && (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter)) {
    const Reading reading = read(lineEdit()->text());
    if (!reading.fault.isEmpty()) {
      showFault(reading);
      lineEdit()->setCursorPosition(reading.position);
      event->accept();
      return;
    }
  }
  QDoubleSpinBox::keyPressEvent(event);
  if (event->key() == Qt::Key_Return || event->key() == Qt::Key_Enter) lineEdit()->setModified(false);
}

void NumberField::changeEvent(QEvent* event) {
  QDoubleSpinBox::changeEvent(event);
  if (event->type() != QEvent::EnabledChange || isEnabled()) return;
  if (actsAtOnce_ && isFaulty()) giveUp(read(lineEdit()->text()));
  // In a window that is not active no event tells of the lost focus: caret and selection would stay.
  QFocusEvent lost(QEvent::FocusOut, Qt::OtherFocusReason);
  QCoreApplication::sendEvent(lineEdit(), &lost);
  lineEdit()->deselect();
}

void NumberField::focusOutEvent(QFocusEvent* event) {
  // A menu takes the focus only for a while.
  if (event->reason() != Qt::PopupFocusReason && lineEdit()->isModified()) {
    const Reading reading = read(lineEdit()->text());
    // Whoever looks something up in another window comes back to the text.
    const bool isLeft = actsAtOnce_ && event->reason() != Qt::ActiveWindowFocusReason;
    if (!reading.fault.isEmpty() && isLeft) {
      giveUp(reading);
    } else if (!reading.fault.isEmpty()) {
      showFault(reading);
      // Its caret goes, as the base class would have it go.
      QCoreApplication::sendEvent(lineEdit(), event);
      QWidget::focusOutEvent(event);
      return;
    }
  }
  QDoubleSpinBox::focusOutEvent(event);
}

void NumberField::giveUp(const Reading& reading) {
  const QString text = lineEdit()->text();
  takeBack();
  emit noted(tr("“%1” was taken back. %2").arg(text, QString(reading.fault).replace('\n', ' ')));
}

void NumberField::showFault(const Reading& reading) {
  fault_ = reading.fault;
  lineEdit()->setStyleSheet(QLatin1String(kFaultyStyle));
  setAccessibleDescription(fault_);
  if (isVisible()) QToolTip::showText(mapToGlobal(QPoint(0, height())), fault_, this, rect(), kFaultTime);
}

void NumberField::clearFault() {
  if (!isFaulty()) return;
  fault_.clear();
  lineEdit()->setStyleSheet({});
  setAccessibleDescription({});
  QToolTip::hideText();
}

}  // namespace nearfit::ui
