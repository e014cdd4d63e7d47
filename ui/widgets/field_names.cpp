#include "ui/widgets/field_names.h"

#include <QAbstractButton>
#include <QGridLayout>
#include <QGroupBox>
#include <QLabel>
#include <QWidget>

namespace nearfit::ui {
namespace {

QString plain(QString text) {
  text.remove(QChar('&')).remove(QChar(':'));
  return text.section('\n', 0, 0).trimmed();
}

/// Returns the text of a label whose buddy is the widget, or one that contains it.
QString nameByBuddy(const QWidget& widget) {
  const QList<QLabel*> labels = widget.window()->findChildren<QLabel*>();
  for (const QWidget* part = &widget; part != nullptr && !part->isWindow(); part = part->parentWidget()) {
    for (const QLabel* label : labels) {
      if (label->buddy() == part) return plain(label->text());
    }
  }
  return {};
}

/// Returns the text of the nearest label before the widget in its row.
QString nameByRow(const QWidget& widget) {
  const QWidget* parent = widget.parentWidget();
  auto* grid = parent != nullptr ? qobject_cast<QGridLayout*>(parent->layout()) : nullptr;
  const int index = grid != nullptr ? grid->indexOf(const_cast<QWidget*>(&widget)) : -1;
  if (index < 0) return {};
  int row = 0, column = 0, rows = 0, columns = 0;
  grid->getItemPosition(index, &row, &column, &rows, &columns);
  for (--column; column >= 0; --column) {
    QLayoutItem* item = grid->itemAtPosition(row, column);
    const auto* label = item != nullptr ? qobject_cast<const QLabel*>(item->widget()) : nullptr;
    if (label != nullptr && !label->text().isEmpty()) return plain(label->text());
  }
  return {};
}

}  // namespace

bool hasAccessibleName(const QWidget& widget) {
  if (!widget.accessibleName().isEmpty()) return true;
  if (const auto* button = qobject_cast<const QAbstractButton*>(&widget)) return !button->text().isEmpty();
  if (const auto* group = qobject_cast<const QGroupBox*>(&widget)) return !group->title().isEmpty();
  if (qobject_cast<const QLabel*>(&widget) != nullptr) return true;  // Names itself.
  const QList<QLabel*> labels = widget.window()->findChildren<QLabel*>();
  for (const QLabel* label : labels) {
    if (label->buddy() == &widget) return true;
  }
  return false;
}

void nameFields(QWidget& root) {
  const QList<QWidget*> widgets = root.findChildren<QWidget*>();
  for (QWidget* widget : widgets) {
    if (widget->focusPolicy() == Qt::NoFocus || hasAccessibleName(*widget)) continue;
    QString name = nameByBuddy(*widget);
    if (name.isEmpty()) name = nameByRow(*widget);
    if (name.isEmpty()) name = plain(widget->toolTip());
    widget->setAccessibleName(name);
  }
}

}  // namespace nearfit::ui
