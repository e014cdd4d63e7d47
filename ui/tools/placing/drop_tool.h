#pragma once

#include <QObject>
#include <vector>

#include <glm/vec3.hpp>

#include "core/session/session.h"
#include "ui/tools/placing/feature_picker.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QAction;
class QMenu;
class QWidget;

namespace nearfit::ui {

class HandState;
class MoveGuard;
class SceneWork;
class Selection;
class Viewport;

/// Moves the selected parts to contact. Drop goes straight along a direction to the first contact; Push
/// goes on along what the parts touch until they are held. The direction is a world axis, either way,
/// or towards a clicked face. Each is one undo step, computed in another thread behind a progress
/// dialog that can cancel it.
class DropTool : public QObject {
  Q_OBJECT

 public:
  /// What it needs; all outlive this.
  struct Context {
    Session& session;
    Selection& selection;
    Viewport& view;
    const MoveGuard& guard;
    const HandState& hand;
    SceneWork& work;
  };
  DropTool(const Context& context, QWidget* window);
  ~DropTool() override;

  /// Adds a submenu for each of drop and push.
  void addTo(QMenu& menu);

 signals:
  /// Emitted when a move failed by an exception.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a note for the status bar: a prompt, the result, or why nothing moves.
  void noted(const QString& text);

 private:
  enum class Kind { Drop, Push };
  struct Outcome {
    RigidTransform worldFromLead;
    double travel = 0.0;  ///< [m]
    QString problem;      ///< Why nothing moves; empty if something does.
    QString against;      ///< Names of the parts touched.
  };

  QMenu* makeMenu(Kind kind);
  /// Enables the actions if the selected parts can be moved now; else stops asking for a face.
  void updateAvailability();
  void askForFace(Kind kind);
  void take(const FeaturePick& pick);
  void stopAsking();
  void run(Kind kind, const glm::dvec3& direction);
  void compute(Kind kind, const std::vector<PartId>& parts, const glm::dvec3& direction);
  void finish(Kind kind, const std::vector<PartId>& parts, const Scene& before, const Outcome& outcome);
  static Outcome dropped(const Scene& scene, const std::vector<PartId>& parts, const glm::dvec3& direction,
                         const ProgressCallback& progress);
  static Outcome pushed(const Scene& scene, const std::vector<PartId>& parts, const glm::dvec3& direction,
                        const ProgressCallback& progress);

  Session& session_;
  Selection& selection_;
  Viewport& view_;
  const MoveGuard& guard_;
  const HandState& hand_;
  SceneWork& work_;
  QWidget* window_;
  std::vector<QAction*> actions_;
  FeaturePicker picker_;
  Kind wanted_ = Kind::Drop;
  BackgroundTask task_;
  Subscription changes_;
};

}  // namespace nearfit::ui
