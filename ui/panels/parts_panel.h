#pragma once

#include <QWidget>
#include <optional>

#include "core/scene/scene.h"

class QAction;
class QTreeView;

namespace nearfit::ui {

class PartsModel;

/// The list of parts: choose one, rename it in place, click its icons. Asks for changes by signals.
class PartsPanel : public QWidget {
  Q_OBJECT

 public:
  explicit PartsPanel(QWidget* parent = nullptr);

  void setScene(const Scene& scene);
  std::optional<PartId> selected() const;
  void select(std::optional<PartId> part);
  /// Actions of the context menu.
  void setMenuActions(const QList<QAction*>& actions);
  /// Starts editing the selected part's name in the list.
  void editName();

 signals:
  void selectionChanged();
  void renameRequested(nearfit::PartId part, const QString& name);
  void movingPartRequested(std::optional<nearfit::PartId> part);
  void visibilityRequested(nearfit::PartId part, bool isVisible);
  void lockRequested(nearfit::PartId part, bool isLocked);

 private:
  void clickCell(const QModelIndex& index);

  PartsModel* model_;
  QTreeView* view_;
  Scene scene_;
};

}  // namespace nearfit::ui
