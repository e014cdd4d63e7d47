#pragma once

#include <QObject>
#include <vector>

class QTableView;

namespace nearfit::ui {

/// Widths of a table's columns: as wide as their contents, within a bound, so that the user sees all columns; what room is
/// left goes to contents beyond their bound, and then to columns that stretch. A column keeps its width when its contents
/// become shorter, or are filtered, so that nothing jumps; one that the user has resized is left alone.
class ColumnWidths : public QObject {
  Q_OBJECT

 public:
  struct Column {
    int most = 0;              ///< Bound of the width that contents ask for [pixels].
    bool isStretched = false;  ///< Shares what room is left.
  };

  /// @param table    Its parent; has a model with as many columns, and keeps that model.
  /// @param columns  In the model's order.
  ColumnWidths(QTableView& table, std::vector<Column> columns);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  /// Takes contents into account.
  void measure();
  void apply();

  QTableView& table_;
  const std::vector<Column> columns_;
  std::vector<int> needed_;    ///< What contents have asked for so far [pixels].
  std::vector<bool> isUsers_;  ///< The user has resized the column.
  bool isApplying_ = false;
};

}  // namespace nearfit::ui
