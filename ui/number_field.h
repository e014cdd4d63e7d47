#pragma once

#include <QDoubleSpinBox>

#include "core/text/quantity.h"
#include "ui/length_unit.h"

namespace nearfit::ui {

/// A number with its unit. Takes quantities with units and arithmetic (core/text/quantity.h): "1/4 in",
/// "2*(3 mm + 0.5 cm)", "+= 5" to add to what is there. Counts once it is left by Return, by the focus or by
/// a step; not at each key. What cannot be read stays as it was typed, marked, with the mistake explained,
/// until it is mended or taken back by Escape; the number is then still the one before.
///
/// value() and the like are in the shown unit; quantity() and the like in SI.
class NumberField : public QDoubleSpinBox {
  Q_OBJECT

 public:
  explicit NumberField(QWidget* parent = nullptr);

  /// A unit as it is shown, with the space before it if it has one: " N/m". One that cannot be read is shown
  /// all the same, and numbers have no dimension then.
  void setUnit(const QString& unit);
  /// A length in the unit that the user has chosen (LengthUnit).
  /// @param decimals  In millimetres.
  void setLength(int decimals);
  /// Only fields of a length follow.
  void setLengthUnit(LengthUnit unit);

  /// In SI, as all of these.
  void setQuantityRange(double lower, double upper);
  void setQuantityStep(double step);
  /// No edit: nothing is told. What is being typed, or cannot be read, is left alone.
  void showQuantity(double value);
  /// Shows a word in place of a number, for several that differ; it has the quantity of the lower limit until
  /// one is typed or shown, and takes no steps.
  void showMixed(const QString& word);
  /// As it was typed or set, not as it is rounded to be shown.
  double quantity() const;
  /// One of the shown unit, in SI.
  double shownUnit() const noexcept { return unit_.inSi; }
  /// "From 0 to 10 mm": the limits in the shown unit.
  QString limitsText() const;

  /// A tool tip, with limitsText() behind it.
  void setHelp(const QString& help);

  /// Shows no zeros behind the last figure, for numbers whose size is anyone's guess.
  void setTrimmed(bool isTrimmed);
  /// Whether the change that is being told comes from a step (arrow, key, wheel), not from typing.
  bool isStepping() const noexcept { return isStepping_; }
  /// Whether something stands here that has not been taken over: it is being typed, or cannot be read.
  bool isUnsettled() const;
  /// Whether what stands here cannot be read.
  bool isFaulty() const noexcept { return !fault_.isEmpty(); }
  /// Takes over what is being typed, as leaving the field does.
  void settle();
  /// Forgets what is being typed.
  void takeBack();

  QString textFromValue(double value) const override;
  double valueFromText(const QString& text) const override;
  QValidator::State validate(QString& text, int& position) const override;
  void stepBy(int steps) override;

 signals:
  /// The user has changed the number. In SI.
  void quantityEdited(double value);

 protected:
  bool event(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;

 private:
  struct Reading {
    double quantity = 0.0;
    QString fault;     ///< Empty when it could be read.
    int position = 0;  ///< Of the mistake, in the text.
  };
  Reading read(const QString& text) const;
  bool isMixed() const;
  void showFault(const Reading& reading);
  void clearFault();
  void applyUnit(const QString& name, double inSi);

  Unit unit_;
  QString unitText_;  ///< With the space before it.
  bool isLength_ = false;
  bool isReadable_ = true;  ///< Of the unit.
  int millimetreDecimals_ = 3;
  double lower_ = 0.0, upper_ = 0.0, step_ = 0.0;  ///< In SI; the step 0 when it is no length's.
  mutable double exact_ = 0.0;                     ///< In SI; counts while it rounds to the number shown.
  QString fault_;
  QString help_;
  bool isTrimmed_ = false;
  bool isStepping_ = false;
};

}  // namespace nearfit::ui
