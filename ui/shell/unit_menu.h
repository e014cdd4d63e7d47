#pragma once

#include <QMenu>

#include "ui/widgets/length_unit.h"

class QActionGroup;

namespace nearfit::ui {

/// The choice of the length unit, kept between runs and passed to every NumberField of the window.
class UnitMenu : public QMenu {
  Q_OBJECT

 public:
  /// Sets shownLengthUnit() to the stored unit.
  /// @param window  The parent; its number fields follow the choice.
  explicit UnitMenu(QWidget* window);

 signals:
  /// Emitted when the user chose a unit, after fields and shownLengthUnit() have changed.
  void unitChanged(nearfit::ui::LengthUnit unit);

 private:
  void choose(LengthUnit unit);

  QWidget* window_;
  QActionGroup* group_;
};

}  // namespace nearfit::ui
