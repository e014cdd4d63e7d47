#pragma once

#include <QWidget>
#include <map>
#include <optional>

#include "core/scene/scene_tree.h"
#include "core/session/scene_events.h"
#include "ui/model/part_checks.h"

class QAction;
class QLineEdit;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class PartsModel;
class PartsView;
class Selection;

/// The tree of the scene's groups and parts: selects, renames in place, toggles icons, drags to other groups,
/// filters by name. Requests changes through signals; PartCommands makes them.
class PartsPanel : public QWidget {
  Q_OBJECT

 public:
  /// @param session, selection  Outlive this.
  PartsPanel(Session& session, Selection& selection, QWidget* parent = nullptr);

  /// Shows the scene anew, in place of a change that was refused.
  void refresh();
  /// Returns the tree, for the order of the Tab key.
  QWidget* list() const noexcept;
  /// Shows a badge in the rows of parts with findings; a click asks for findingsRequested().
  void showFindings(std::map<PartId, FindingsBadge> findings);
  /// Sets the actions of the context menu.
  void setMenuActions(const QList<QAction*>& actions);
  /// Edits the name in the current row, of a part or a group; no-op unless the row is selected. If the panel
  /// is in a dock, shows that.
  void editName();

 signals:
  void renameRequested(nearfit::PartId part, const QString& name);
  /// Emitted when a typed name was refused and discarded.
  void renameRefused(const QString& reason);
  void groupRenameRequested(nearfit::GroupId group, const QString& name);
  void movingPartRequested(std::optional<nearfit::PartId> part);
  void movingGroupRequested(nearfit::GroupId group);
  void visibilityRequested(const std::vector<nearfit::PartId>& parts, bool isVisible);
  /// Emitted when the joints of a part are to be turned off, or on if none is.
  void jointToggleRequested(nearfit::PartId part);
  /// Emitted when the user wants to see what is wrong with a part.
  void findingsRequested(nearfit::PartId part);
  void lockRequested(const nearfit::SceneNodes& nodes, bool isLocked);
  void regroupRequested(const nearfit::SceneNodes& nodes, std::optional<nearfit::GroupId> target);

 private:
  void clickCell(const QModelIndex& index);
  void toggleVisible(const QModelIndex& index);
  void toggleLock(const QModelIndex& index);
  /// Returns what a click in this row affects: the whole selection if it includes the row,
  /// else the row alone.
  SceneNodes nodesOf(const QModelIndex& index) const;
  void takeSelection();
  enum class Reveal { Yes, No };
  /// @param reveal  Whether to scroll to the current part and to open the groups around it.
  void showSelection(Reveal reveal);
  /// Returns the groups whose rows are open.
  std::vector<GroupId> expandedGroups() const;

  Session& session_;
  Selection& selection_;
  PartsModel* model_;
  PartsView* view_;
  QLineEdit* filter_;
  Scene scene_;                 ///< As shown.
  std::vector<GroupId> known_;  ///< Groups that were there before; new ones are opened.
  bool isShowing_ = false;      ///< Rows follow the selection, not the user.
  Subscription changes_;
};

}  // namespace nearfit::ui
