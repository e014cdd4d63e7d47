#pragma once

#include <QWidget>

#include "core/session/session.h"

class QListView;

namespace nearfit::ui {

class HistoryModel;
class SceneWork;

/// Lists the steps of undo and redo; a click or Return goes to one, unless the scene is being worked on.
class HistoryPanel : public QWidget {
  Q_OBJECT

 public:
  /// @param session, work  Outlive this.
  HistoryPanel(Session& session, const SceneWork& work, QWidget* parent = nullptr);

  /// Updates the texts after a change of the unit of length.
  void refresh();

 private:
  void showHistory();
  void goTo(int row);

  Session& session_;
  HistoryModel* model_;
  QListView* view_;
  Subscription changes_;
};

}  // namespace nearfit::ui
