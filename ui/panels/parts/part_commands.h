#pragma once

#include <QList>
#include <QObject>
#include <functional>
#include <optional>
#include <vector>

#include "core/scene/scene_tree.h"
#include "core/session/scene_events.h"
#include "ui/widgets/error_box.h"

class QAction;
class QWidget;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class HandState;
class JointActions;
class PartsPanel;
class SceneWork;
class Selection;
class TreeActions;

/// Commands on parts and groups, by actions on the selection and in the tree of parts. Each is one undo step
/// of the session.
class PartCommands : public QObject {
  Q_OBJECT

 public:
  /// What the commands act on, and what they wait for. All outlive this.
  struct Context {
    Session& session;
    Selection& selection;
    const HandState& hand;
    const SceneWork& work;
  };
  /// @param panel   Its requests become commands; outlives this.
  /// @param window  The parent, and that of dialogs.
  PartCommands(const Context& context, PartsPanel& panel, QWidget* window);

  QAction *duplicate, *rename, *recolour, *changeUnit, *refine, *check, *takeInHand, *remove, *selectAll,
      *selectNone;

  /// The actions on groups, visibility and locks.
  const TreeActions& tree() const noexcept { return *tree_; }
  /// The actions on joints.
  const JointActions& joints() const noexcept { return *joints_; }
  /// Returns the actions that a context menu offers for what is selected.
  const QList<QAction*>& menu() const noexcept { return menu_; }

 signals:
  /// Emitted when the part in hand is deleted or another one is taken. The receiver must stop the servo, and
  /// so put the part down, before it returns.
  void servoStopRequested();
  /// Emitted when the servo ran before another part was taken in hand, and is to go on with that.
  void servoStartRequested();
  /// Emitted when the user wants to change the unit of parts' files.
  void unitChangeRequested(const std::vector<nearfit::PartId>& parts);
  /// Emitted when the user wants to see what is wrong with the mesh of the selected part.
  void checkRequested();
  /// Emitted when the user wants to change the tessellation of parts.
  void refineRequested(const std::vector<nearfit::PartId>& parts);
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  void makeActions();
  void makeMenu();
  void connectActions();
  void connectPanel(PartsPanel& panel);
  void update();
  /// Runs a command of the session. If it throws, shows the failure under `heading`, and the scene anew.
  void attempt(const QString& heading, const std::function<void()>& command);
  void take(std::optional<PartId> part);
  void takeGroup(GroupId group);
  /// Takes the selected group in hand if one is selected by itself, else the current part.
  void takeSelected();
  /// Returns that group.
  std::optional<GroupId> selectedGroup() const;
  /// Puts down what is in hand, runs a command that takes something else, and goes on if it was felt.
  void takeAnother(const QString& heading, const std::function<void()>& command);
  /// Locks or unlocks. Locking the moving part puts it down; refused while it is being felt.
  void setLocked(const SceneNodes& nodes, bool isLocked);
  void deleteSelected();
  void duplicateSelected();
  void recolourSelected();

  const Context context_;
  PartsPanel& panel_;
  QWidget* window_;
  TreeActions* tree_;
  JointActions* joints_;
  QList<QAction*> menu_;
  Subscription changes_;
};

}  // namespace nearfit::ui
