#pragma once

#include <QDoubleSpinBox>

namespace nearfit::ui {

/// A number with its unit. Counts once it is left by Return, by the focus or by a step; not at each key.
class NumberField : public QDoubleSpinBox {
  Q_OBJECT

 public:
  explicit NumberField(QWidget* parent = nullptr);

  /// Shows no zeros behind the last figure, for numbers whose size is anyone's guess.
  void setTrimmed(bool isTrimmed);
  /// Whether the change that is being told comes from a step (arrow, key, wheel), not from typing.
  bool isStepping() const noexcept { return isStepping_; }

  QString textFromValue(double value) const override;
  void stepBy(int steps) override;

 private:
  bool isTrimmed_ = false;
  bool isStepping_ = false;
};

}  // namespace nearfit::ui
