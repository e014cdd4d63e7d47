#pragma once

#include <QObject>
#include <QPointer>
#include <functional>
#include <vector>

#include <glm/vec3.hpp>

#include "core/session.h"
#include "ui/background_task.h"
#include "ui/dialogs/error_box.h"
#include "ui/placing/feature_picker.h"

class QAction;
class QMenu;
class QWidget;

namespace nearfit::ui {

class ProgressDialog;
class Selection;
class Viewport;

/// Moves the selected parts until they touch something: "Drop" straight along a direction to the first
/// contact, "Push" on from there along what they touch, until they are held. Down, up, along each axis of the
/// world, or towards a face that is clicked in the view. One step of undo each; computed in another thread,
/// with a way to stop it.
class DropTool : public QObject {
  Q_OBJECT

 public:
  /// Makes what it takes to compute ready, and calls back with whether it is.
  using Prepare = std::function<void(std::function<void(bool isReady)>)>;
  /// @param session, selection, view  Outlive this.
  DropTool(Session& session, Selection& selection, Viewport& view, Prepare prepare, QWidget* window);
  ~DropTool() override;

  void addTo(QMenu& menu);
  /// Whether parts can be moved now.
  void setAvailable(bool isAvailable);

 signals:
  void failed(const nearfit::ui::Failure& failure);
  void noted(const QString& text);

 private:
  enum class Kind { Drop, Push };
  struct Outcome {
    RigidTransform worldFromLead;
    double travel = 0.0;  ///< [m]
    QString problem;      ///< Why nothing moves; empty when something does.
    QString against;
  };

  QMenu* makeMenu(Kind kind);
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
  Prepare prepare_;
  QWidget* window_;
  std::vector<QAction*> actions_;
  FeaturePicker picker_;
  Kind wanted_ = Kind::Drop;
  BackgroundTask task_;
  QPointer<ProgressDialog> progress_;
};

}  // namespace nearfit::ui
