#pragma once

#include <QAbstractListModel>
#include <string>
#include <vector>

namespace nearfit::ui {

/// What undo and redo can go to, oldest first, with the present state marked and what is undone faint.
class HistoryModel : public QAbstractListModel {
  Q_OBJECT

 public:
  using QAbstractListModel::QAbstractListModel;

  /// @param labels   As Session::history gives them.
  /// @param current  Index of the present state.
  void show(std::vector<std::string> labels, int current);
  int current() const noexcept { return current_; }

  int rowCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;

 private:
  QString text(int row) const;

  std::vector<std::string> labels_;
  int current_ = 0;
};

}  // namespace nearfit::ui
