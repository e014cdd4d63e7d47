#pragma once

#include <QAbstractListModel>
#include <vector>

#include "core/session.h"

namespace nearfit::ui {

/// What undo and redo can go to, oldest first, with the present state marked and what is undone faint.
class HistoryModel : public QAbstractListModel {
  Q_OBJECT

 public:
  using QAbstractListModel::QAbstractListModel;

  /// @param steps    As Session::history gives them.
  /// @param current  Index of the present state.
  void show(std::vector<Session::Step> steps, int current);
  /// Lengths are in another unit now.
  void refresh();
  int current() const noexcept { return current_; }

  int rowCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;

 private:
  QString text(int row) const;

  std::vector<Session::Step> steps_;
  int current_ = 0;
};

}  // namespace nearfit::ui
