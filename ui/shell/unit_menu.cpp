#include "ui/shell/unit_menu.h"

#include <QActionGroup>

#include "ui/widgets/number_field.h"
#include "ui/widgets/preferences.h"

namespace nearfit::ui {

UnitMenu::UnitMenu(QWidget* window)
    : QMenu(tr("&Unit of length"), window), window_(window), group_(new QActionGroup(this)) {
  setObjectName(QStringLiteral("unitMenu"));
  setShownLengthUnit(Preferences::lengthUnit());
  for (const LengthUnit unit : kLengthUnits) {
    QAction* action = addAction(tr("%1 (%2)").arg(nameOf(unit), symbolOf(unit)));
    action->setObjectName(QStringLiteral("unit-") + symbolOf(unit));
    action->setCheckable(true);
    action->setChecked(unit == Preferences::lengthUnit());
    group_->addAction(action);
    connect(action, &QAction::triggered, this, [this, unit] { choose(unit); });
  }
}

void UnitMenu::choose(LengthUnit unit) {
  Preferences::setLengthUnit(unit);
  setShownLengthUnit(unit);
  for (NumberField* field : window_->findChildren<NumberField*>())
    field->setLengthUnit(unit);
  // Painted lengths are formatted while painting.
  for (QWidget* widget : window_->findChildren<QWidget*>())
    widget->update();
  emit unitChanged(unit);
}

}  // namespace nearfit::ui
