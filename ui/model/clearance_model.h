#pragma once

#include <QAbstractTableModel>
#include <optional>
#include <vector>

#include "core/report/clearance.h"

namespace nearfit::ui {

/// Clearances as a table: the other part, the least distance, minima within the cutoff, and a verdict.
class ClearanceModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { Other, Distance, Minima, Verdict, ColumnCount };
  /// Role for the value that a column is sorted by.
  static constexpr int kSortRole = Qt::UserRole;

  using QAbstractTableModel::QAbstractTableModel;

  /// Replaces the rows.
  /// @param scene  Gives the parts' names.
  void show(const std::vector<PartClearance>& clearances, const Scene& scene);
  /// Sets the distance below which a pair is too near [m].
  void setThreshold(double metres);
  /// Returns the clearance in a row; `row` must be valid.
  const PartClearance& at(int row) const { return rows_[static_cast<std::size_t>(row)].clearance; }
  /// Returns the distance as shown, or the word for parts that touch or overlap.
  static QString valueOf(const PartClearance& clearance);
  /// Returns the row of another part; std::nullopt if there is none.
  std::optional<int> rowOf(PartId other) const;

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  struct Row {
    PartClearance clearance;
    QString name;
  };
  bool isTooNear(const PartClearance& clearance) const;
  QString textOf(const Row& row, int column) const;
  QVariant sortKeyOf(const Row& row, int column) const;

  std::vector<Row> rows_;
  double threshold_ = 0.0;
};

}  // namespace nearfit::ui
