#pragma once

#include <QAbstractTableModel>
#include <memory>

#include "core/mesh/check/mesh_check.h"

namespace nearfit::ui {

/// Findings of a mesh as a table: kind, count, size, place and what they mean for contact.
class FindingsModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { Kind, Count, Size, Place, Effect, ColumnCount };
  /// Role for the value that a column is sorted by.
  static constexpr int kSortRole = Qt::UserRole;

  using QAbstractTableModel::QAbstractTableModel;

  /// Replaces the rows; null: none.
  void show(std::shared_ptr<const MeshCheck> check);
  /// Tells that lengths are shown in another unit.
  void refresh();
  /// Returns the finding in a row; `row` must be valid.
  const MeshFinding& at(int row) const { return check_->findings[static_cast<std::size_t>(row)]; }

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;
  QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  static QString textOf(const MeshFinding& finding, int column);
  /// The whole text of a cell that may be elided, or the meaning of its number.
  static QString toolTipOf(const MeshFinding& finding, int column);
  static QVariant sortKeyOf(const MeshFinding& finding, int column);

  std::shared_ptr<const MeshCheck> check_;
};

}  // namespace nearfit::ui
