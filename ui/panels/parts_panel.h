#pragma once

#include <QWidget>
#include <optional>

#include "core/scene/scene_tree.h"

class QAction;
class QLineEdit;

namespace nearfit::ui {

class PartsModel;
class PartsView;
class Selection;

/// The tree of groups and parts: choose some, rename one in place, click its icons, drag them into another
/// group, look for a name. Asks for changes by signals.
class PartsPanel : public QWidget {
  Q_OBJECT

 public:
  /// @param selection  Outlives this.
  explicit PartsPanel(Selection& selection, QWidget* parent = nullptr);

  void setScene(const Scene& scene);
  /// Actions of the context menu.
  void setMenuActions(const QList<QAction*>& actions);
  /// Starts editing the name of the current row: of the current part, or of the group that was chosen.
  void editName();

 signals:
  void renameRequested(nearfit::PartId part, const QString& name);
  /// A name that was typed was not taken, and is gone.
  void renameRefused(const QString& reason);
  void groupRenameRequested(nearfit::GroupId group, const QString& name);
  void movingPartRequested(std::optional<nearfit::PartId> part);
  void visibilityRequested(const std::vector<nearfit::PartId>& parts, bool isVisible);
  void lockRequested(const nearfit::SceneNodes& nodes, bool isLocked);
  void regroupRequested(const nearfit::SceneNodes& nodes, std::optional<nearfit::GroupId> target);

 private:
  void clickCell(const QModelIndex& index);
  void toggleVisible(const QModelIndex& index);
  void toggleLock(const QModelIndex& index);
  /// What a switch in this row is about: all that is selected when the row is, else the row alone.
  SceneNodes nodesOf(const QModelIndex& index) const;
  void takeSelection();
  enum class Reveal { Yes, No };
  /// @param reveal  Whether the current part is scrolled to, and the groups opened that it is in.
  void showSelection(Reveal reveal);
  /// Groups whose rows show what they hold.
  std::vector<GroupId> expandedGroups() const;

  Selection& selection_;
  PartsModel* model_;
  PartsView* view_;
  QLineEdit* filter_;
  Scene scene_;
  std::vector<GroupId> known_;  ///< Groups that were there before: new ones are opened.
  bool isShowing_ = false;      ///< The rows follow the selection, not the user.
};

}  // namespace nearfit::ui
