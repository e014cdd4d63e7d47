#pragma once

#include <QMenu>

#include "ui/length_unit.h"

class QActionGroup;

namespace nearfit::ui {

/// The choice of the unit that lengths are shown in; remembered from one run to the next, and brought to
/// every number field of the window.
class UnitMenu : public QMenu {
  Q_OBJECT

 public:
  explicit UnitMenu(QWidget* window);

 signals:
  void unitChanged(nearfit::ui::LengthUnit unit);

 private:
  void choose(LengthUnit unit);

  QWidget* window_;
  QActionGroup* group_;
};

}  // namespace nearfit::ui
