#pragma once

#include <QList>
#include <QObject>
#include <QString>
#include <functional>
#include <memory>
#include <vector>

#include "core/scene/scene_tree.h"
#include "core/session/scene_events.h"

class QAction;
class QMenu;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class SceneWork;
class Selection;

/// Actions on the selected groups and parts: group and ungroup, hide and show, lock, isolate, make
/// transparent. Each runs a command of the session, one undo step.
class TreeActions : public QObject {
  Q_OBJECT

 public:
  /// Runs a command; shows its refusal under a heading.
  using Attempt = std::function<void(const QString& heading, const std::function<void()>& command)>;

  /// @param session, selection, work  Outlive this.
  TreeActions(Session& session, Selection& selection, const SceneWork& work, Attempt attempt,
              QObject* parent = nullptr);
  ~TreeActions() override;

  /// Appends the actions to a menu.
  void addTo(QMenu& menu) const;
  /// Returns the actions for a context menu.
  QList<QAction*> list() const;

 signals:
  /// Emitted when the user locks or unlocks the selected nodes.
  void lockRequested(const nearfit::SceneNodes& nodes, bool isLocked);

 private:
  QAction* make(const char* name, const QString& text, const QString& icon, const QString& keys,
                const QString& help, void (TreeActions::*run)());
  /// Enables the actions that are possible now.
  void update();
  void setUpTransparency();
  void groupSelected();
  void ungroupSelected();
  void toggleVisible();
  void toggleLock();
  void isolate();
  void endIsolation();
  void setOpacity(double opacity);
  /// True if there are selected parts and all of them fulfil the predicate.
  bool areAll(const std::function<bool(const Part&)>& predicate) const;
  /// True if all selected nodes are locked by themselves.
  bool areNodesLocked() const;

  Session& session_;
  Selection& selection_;
  const SceneWork& work_;
  Attempt attempt_;
  QAction *group_, *ungroup_, *visible_, *lock_, *isolate_, *endIsolation_;
  std::unique_ptr<QMenu> transparency_;
  std::vector<QAction*> opacities_;
  Subscription changes_;
};

}  // namespace nearfit::ui
