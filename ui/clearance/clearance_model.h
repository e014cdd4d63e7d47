#pragma once

#include <QAbstractTableModel>
#include <optional>
#include <vector>

#include "core/report/clearance.h"

namespace nearfit::ui {

/// Clearances as a table: the other part, the least distance, minima within the cutoff, and what that means.
class ClearanceModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { Other, Distance, Minima, Verdict, ColumnCount };
  /// What a column is sorted by.
  static constexpr int kSortRole = Qt::UserRole;

  using QAbstractTableModel::QAbstractTableModel;

  /// @param scene  For the names.
  void show(const std::vector<PartClearance>& clearances, const Scene& scene);
  /// Less than this is too near [m].
  void setThreshold(double metres);
  const PartClearance& at(int row) const { return rows_[static_cast<std::size_t>(row)].clearance; }
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
