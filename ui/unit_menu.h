#pragma once

#include <QMenu>

#include "ui/length_unit.h"

class QActionGroup;

namespace nearfit::ui {

/// The choice of the length unit, kept between runs and passed to every NumberField of the window.
/// @param window  Parent, and root of the fields to update. Sets shownLengthUnit() to the stored unit.
class UnitMenu : public QMenu {
  Q_OBJECT

 public:
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
