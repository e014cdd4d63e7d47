#pragma once

#include <QAbstractListModel>
#include <QWidget>
#include <vector>

#include "core/session/session.h"

class QListView;

namespace nearfit::ui {

class SceneWork;

/// Steps that undo and redo can go to, oldest first; marks the present state and shows undone steps faintly.
class HistoryModel : public QAbstractListModel {
  Q_OBJECT

 public:
  using QAbstractListModel::QAbstractListModel;

  /// @param steps  Steps from Session::history().
  /// @param current  Index of the present state.
  void show(std::vector<Session::Step> steps, int current);
  /// Updates the texts after a change of the unit of length.
  void refresh();
  int current() const noexcept { return current_; }

  int rowCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role) const override;

 private:
  QString text(int row) const;

  std::vector<Session::Step> steps_;
  int current_ = 0;
};

/// Lists the steps of undo and redo; a click or Return goes to one, unless the scene is being worked on.
class HistoryPanel : public QWidget {
  Q_OBJECT

 public:
  /// @param session, work  Outlive this.
  HistoryPanel(Session& session, const SceneWork& work, QWidget* parent = nullptr);

  /// Updates the texts after a change of the unit of length.
  void refresh();
  /// Returns the list, for the order of the Tab key.
  QWidget* list() const noexcept;

 private:
  void showHistory();
  void goTo(int row);

  Session& session_;
  HistoryModel* model_;
  QListView* view_;
  Subscription changes_;
};

}  // namespace nearfit::ui
