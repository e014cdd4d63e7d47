#pragma once

class QTableView;
class QWidget;

namespace nearfit::ui {

/// Sets up a table whose rows are chosen one at a time: sorted by its headers, not edited, left by Tab.
void setUpRowTable(QTableView& table);
/// Lets Escape choose no row, in the table and wherever in the window nothing has handled the key, such as an active tool.
/// Ignored while no row is chosen or the table is hidden.
/// @param window  Outlives the table.
void clearRowsByEscape(QTableView& table, QWidget& window);

}  // namespace nearfit::ui
