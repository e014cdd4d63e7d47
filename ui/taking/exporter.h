#pragma once

#include <QObject>
#include <QPointer>
#include <functional>
#include <memory>

#include "core/report/scene_export.h"
#include "core/session.h"
#include "ui/background_task.h"
#include "ui/dialogs/error_box.h"

class QWidget;

namespace nearfit::ui {

class ProgressDialog;
class Selection;

/// Takes the scene's placements and meshes away: asks what and where to, writes it in another thread, copies
/// a pose to the clipboard.
class Exporter : public QObject {
  Q_OBJECT

 public:
  /// Where the moving part is now; anything when there is none.
  using PoseOfMoving = std::function<RigidTransform()>;

  /// @param session, selection, window  Outlive this.
  Exporter(Session& session, Selection& selection, PoseOfMoving poseOfMoving, QWidget* window);
  ~Exporter() override;

  /// Does nothing while something is being written.
  void askAndExport();
  /// The current part's pose as a matrix (matrixText); the moving part's when none is selected.
  void copyPlacement();

 signals:
  void failed(const nearfit::ui::Failure& failure);
  void noted(const QString& text);

 private:
  void write(const SceneExport& what, const QString& file);

  Session& session_;
  Selection& selection_;
  const PoseOfMoving poseOfMoving_;
  QWidget* window_;
  BackgroundTask task_;
  QPointer<ProgressDialog> progress_;
};

}  // namespace nearfit::ui
