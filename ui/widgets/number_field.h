#pragma once

#include <QDoubleSpinBox>

#include "core/text/quantity.h"
#include "ui/widgets/length_unit.h"

namespace nearfit::ui {

/// A field for a number with a unit. Takes units and arithmetic as core/text/quantity.h does: "1/4 in",
/// "2*(3 mm + 0.5 cm)", "+= 5" to add to the present value. Commits on Return, loss of focus or a step, not
/// on each key. Text that cannot be read stays as typed, marked and with the mistake explained, until it
/// is corrected or reverted by Escape, or left if the field acts at once; the value does not change meanwhile. A
/// double click selects all. Large numbers are shown with fewer decimals, so that their unit has room; the value
/// keeps them.
///
/// value() and other members of QDoubleSpinBox use the shown unit; quantity() and its like use SI.
class NumberField : public QDoubleSpinBox {
  Q_OBJECT

 public:
  explicit NumberField(QWidget* parent = nullptr);

  /// Sets the unit, written as shown, with a leading space if it has one: " N/m". An unknown unit is shown
  /// too, and the number then has no dimension.
  void setUnit(const QString& unit);
  /// Makes this a length in the unit that the user chose (LengthUnit).
  /// @param decimals  Decimals in millimetres.
  void setLength(int decimals);
  /// Changes the shown unit and keeps the quantity. Ignored unless setLength() was called.
  void setLengthUnit(LengthUnit unit);

  /// Sets the limits [SI].
  void setQuantityRange(double lower, double upper);
  /// Sets the step of arrows and wheel [SI], rounded to 1, 2 or 5 times a power of ten of the shown unit.
  void setQuantityStep(double step);
  /// Shows a quantity [SI] without emitting a signal. Ignored while the user is typing or
  /// the text cannot be read. If all was selected, all stays selected while the field is enabled.
  void showQuantity(double value);
  /// Shows a word instead of a number, for several values that differ. Until a number is typed or shown,
  /// quantity() is the lower limit and steps do nothing.
  void showMixed(const QString& word);
  /// Returns the quantity as typed or set [SI], not as rounded for display.
  double quantity() const;
  /// Returns the size of one shown unit [SI].
  double shownUnit() const noexcept { return unit_.inSi; }
  /// Returns the limits in the shown unit: "From 0 to 10 mm".
  QString limitsText() const;

  /// Sets the tool tip: `help`, then limitsText().
  void setHelp(const QString& help);

  /// Hides trailing zeros, for numbers of any magnitude.
  void setTrimmed(bool isTrimmed);
  /// Says that nothing but the field itself takes its number: left with text that cannot be read, it shows the value again
  /// and emits noted(). Otherwise such text stays, for a button that refuses it.
  void setActingAtOnce() { actsAtOnce_ = true; }
  /// True while quantityEdited() comes from a step (arrow, key, wheel) instead of typing.
  bool isStepping() const noexcept { return isStepping_; }
  /// True if the text is not committed: being typed, or cannot be read.
  bool isUnsettled() const;
  /// True if the text cannot be read.
  bool isFaulty() const noexcept { return !fault_.isEmpty(); }
  /// Commits text being typed, as leaving the field does; marks it if it cannot be read.
  void settle();
  /// Discards text being typed and shows the value again.
  void takeBack();

  QString textFromValue(double value) const override;
  double valueFromText(const QString& text) const override;
  QValidator::State validate(QString& text, int& position) const override;
  /// Changes nothing: what cannot be read stays as typed.
  void fixup(QString& /*text*/) const override {}
  void stepBy(int steps) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 signals:
  /// Emitted when the user has changed the number; `value` in SI.
  void quantityEdited(double value);
  /// Emitted with a short note for the status bar when a field that acts at once was left with text that cannot be read.
  void noted(const QString& text);

 protected:
  bool event(QEvent* event) override;
  void changeEvent(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;

 private:
  struct Reading {
    double quantity = 0.0;
    QString fault;     ///< Empty if it could be read.
    int position = 0;  ///< Index of the mistake in the text.
  };
  Reading read(const QString& text) const;
  bool isMixed() const;
  void showFault(const Reading& reading);
  /// Takes back text that cannot be read, and says so.
  void giveUp(const Reading& reading);
  void clearFault();
  void applyUnit(const QString& name, double inSi);

  Unit unit_;
  QString unitText_;  ///< With its leading space.
  bool isLength_ = false;
  bool isReadable_ = true;  ///< False: the unit is unknown.
  int millimetreDecimals_ = 3;
  double lower_ = 0.0, upper_ = 0.0, step_ = 0.0;  ///< In SI; step_ is 0 until set.
  mutable double exact_ = 0.0;                     ///< In SI; valid while it rounds to value().
  QString fault_;
  QString help_;
  bool isTrimmed_ = false;
  bool isStepping_ = false;
  bool actsAtOnce_ = false;
};

}  // namespace nearfit::ui
