#pragma once

#include <QObject>
#include <QPointer>
#include <functional>
#include <memory>

#include "core/report/scene_export.h"
#include "core/session/session.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QWidget;

namespace nearfit::ui {

class ProgressDialog;
class Selection;

/// Exports the scene's placements and meshes: asks what and where to, writes it in another thread; copies a
/// pose to the clipboard.
class Exporter : public QObject {
  Q_OBJECT

 public:
  /// Returns the moving part's worldFromPart now; anything if there is none.
  using PoseOfMoving = std::function<RigidTransform()>;

  /// @param session    Must outlive this.
  /// @param selection  Must outlive this.
  /// @param window     Must outlive this.
  Exporter(Session& session, Selection& selection, PoseOfMoving poseOfMoving, QWidget* window);
  ~Exporter() override;

  /// Asks what to export and writes it; no-op while something is being written.
  void askAndExport();
  /// Copies the current part's pose as a matrix (matrixText()); the moving part's if none is selected.
  void copyPlacement();

 signals:
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
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
