#pragma once

#include <QList>
#include <QObject>
#include <QString>
#include <functional>
#include <memory>
#include <vector>

#include "core/scene/scene_tree.h"

class QAction;
class QMenu;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class Selection;

/// What is done with the selected groups and parts: group and ungroup, hide and show, lock, isolate, make
/// transparent. Issues the session's commands; each is one step of undo.
class TreeActions : public QObject {
  Q_OBJECT

 public:
  /// Runs a command; shows its refusal under that heading.
  using Attempt = std::function<void(const QString& heading, const std::function<void()>& command)>;

  /// @param session, selection  Outlive this.
  TreeActions(Session& session, Selection& selection, Attempt attempt, QObject* parent = nullptr);
  ~TreeActions() override;

  /// Puts them into a menu, behind what is there.
  void addTo(QMenu& menu) const;
  /// For a context menu.
  QList<QAction*> list() const;
  /// What can be done now.
  void update(bool isBusy);

 signals:
  void lockRequested(const nearfit::SceneNodes& nodes, bool isLocked);

 private:
  QAction* make(const char* name, const QString& text, const QString& icon, const QString& keys,
                void (TreeActions::*run)());
  void setUpTransparency();
  void groupSelected();
  void ungroupSelected();
  void toggleVisible();
  void toggleLock();
  void isolate();
  void endIsolation();
  void setOpacity(double opacity);
  /// Whether all selected parts, and there are some, are so.
  bool areAll(const std::function<bool(const Part&)>& predicate) const;
  /// The locks of the selected nodes themselves.
  bool areNodesLocked() const;

  Session& session_;
  Selection& selection_;
  Attempt attempt_;
  QAction *group_, *ungroup_, *visible_, *lock_, *isolate_, *endIsolation_;
  std::unique_ptr<QMenu> transparency_;
  std::vector<QAction*> opacities_;
};

}  // namespace nearfit::ui
