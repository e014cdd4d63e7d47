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

/// Keeps the texts of neighbouring columns apart, in the header and the rows, where one is aligned to the right and the
/// next one to the left. Only WindowStyle knows of it.
void keepColumnsApart(QTableView& table);
/// Returns how much more room than usual there is on either side of a text of such a table or its header [pixels]; 0 for
/// other widgets and for null.
int columnGapOf(const QWidget* widget);

}  // namespace nearfit::ui
