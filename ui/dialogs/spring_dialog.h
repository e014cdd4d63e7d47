#pragma once

#include <QDialog>

#include "core/haptics/spring_law.h"

class QComboBox;
class QDoubleSpinBox;
class QLabel;

namespace nearfit::ui {

/// The springs that minima act as. Each change counts at once; undo takes it back. Stays open beside the
/// window.
class SpringDialog : public QDialog {
  Q_OBJECT

 public:
  explicit SpringDialog(QWidget* parent = nullptr);

  void showSprings(const SpringParameters& springs);

 signals:
  void springsEdited(const nearfit::SpringParameters& springs);

 private:
  QDoubleSpinBox* makeField(const QString& name, int decimals);
  void edit();
  void explainLaw();

  SpringParameters springs_;
  QDoubleSpinBox *cutoff_, *stiffness_, *damping_;
  QComboBox* law_;
  QLabel* explanation_;
};

}  // namespace nearfit::ui
