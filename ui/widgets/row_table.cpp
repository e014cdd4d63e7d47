#include "ui/widgets/row_table.h"

#include <QHeaderView>
#include <QTableView>

#include "ui/widgets/font_scale.h"

namespace nearfit::ui {

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

}  // namespace nearfit::ui
