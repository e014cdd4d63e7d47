#pragma once

class QTableView;

namespace nearfit::ui {

/// Sets up a table whose rows are chosen one at a time: sorted by its headers, not edited, left by Tab.
void setUpRowTable(QTableView& table);

}  // namespace nearfit::ui
