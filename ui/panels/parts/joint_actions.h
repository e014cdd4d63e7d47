#pragma once

#include <QObject>
#include <functional>
#include <memory>
#include <vector>

#include "core/scene/joint.h"
#include "core/session/scene_events.h"

class QAction;
class QMenu;

namespace nearfit {
class Session;
}

namespace nearfit::ui {

class SceneWork;
class Selection;

/// Actions on the joints of the selected parts: remove them, turn them on and off, all at once or one by one. Each runs
/// a command of the session, one undo step.
class JointActions : public QObject {
  Q_OBJECT

 public:
  /// Runs a command; shows its refusal under a heading.
  using Attempt = std::function<void(const QString& heading, const std::function<void()>& command)>;

  /// @param session, selection, work  Outlive this.
  JointActions(Session& session, const Selection& selection, const SceneWork& work, Attempt attempt,
               QObject* parent);
  ~JointActions() override;

  /// The submenu *Joints*, for menus.
  QMenu& menu() const noexcept { return *menu_; }
  /// Turns all joints of a part off, or on if none is.
  void toggle(PartId part);

 private:
  /// Lists the joints of the selected parts, and enables what is possible now.
  void update();
  void list(const std::vector<Joint>& joints);
  std::vector<Joint> selectedJoints() const;
  void removeAll();
  void turnAll();
  void remove(const std::vector<JointId>& joints);
  void turn(const std::vector<JointId>& joints, bool isOn);

  Session& session_;
  const Selection& selection_;
  const SceneWork& work_;
  Attempt attempt_;
  QAction *remove_, *turn_;
  std::unique_ptr<QMenu> menu_;
  std::vector<QAction*> each_;  ///< Of single joints, after the others.
  Subscription changes_;
};

}  // namespace nearfit::ui
