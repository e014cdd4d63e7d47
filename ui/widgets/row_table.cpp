#include "ui/widgets/row_table.h"

#include <QHeaderView>
#include <QItemSelectionModel>
#include <QKeyEvent>
#include <QTableView>
#include <QVariant>

#include "ui/widgets/font_scale.h"

namespace nearfit::ui {
namespace {

/// Property of a table and its header.
constexpr const char* kColumnGap = "columnGap";
/// More room on either side of each text: numbers end at the right of their column, where the texts of the next begin
/// [pixels].
constexpr int kColumnRoom = 5;

/// Gets only those keys of the window that nothing in it has handled.
class EscapeOfRows : public QObject {
 public:
  explicit EscapeOfRows(QTableView& table) : QObject(&table), table_(table) {}

  bool eventFilter(QObject* watched, QEvent* event) override {
    const bool isEscape =
        event->type() == QEvent::KeyPress && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape;
    if (!isEscape || !table_.isVisible() || !table_.selectionModel()->hasSelection())
      return QObject::eventFilter(watched, event);
    table_.clearSelection();
    return true;
  }

 private:
  QTableView& table_;
};

}  // namespace

void setUpRowTable(QTableView& table) {
  table.setSortingEnabled(true);
  table.setSelectionBehavior(QAbstractItemView::SelectRows);
  table.setSelectionMode(QAbstractItemView::SingleSelection);
  table.setEditTriggers(QAbstractItemView::NoEditTriggers);
  table.setTabKeyNavigation(false);
  table.setShowGrid(false);
  table.setAlternatingRowColors(true);
  table.verticalHeader()->hide();
  table.verticalHeader()->setDefaultSectionSize(forFont(table, 24));
}

void clearRowsByEscape(QTableView& table, QWidget& window) {
  auto* escape = new EscapeOfRows(table);
  table.installEventFilter(escape);
  window.installEventFilter(escape);
}

void keepColumnsApart(QTableView& table) {
  for (QWidget* each : {static_cast<QWidget*>(&table), static_cast<QWidget*>(table.horizontalHeader())})
    each->setProperty(kColumnGap, forFont(table, kColumnRoom));
}

int columnGapOf(const QWidget* widget) {
  return widget != nullptr ? widget->property(kColumnGap).toInt() : 0;
}

}  // namespace nearfit::ui
