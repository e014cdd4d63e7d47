#pragma once

#include <QObject>
#include <functional>
#include <memory>
#include <optional>

#include "core/report/scene_export.h"
#include "core/session/session.h"
#include "ui/widgets/background_task.h"
#include "ui/widgets/error_box.h"

class QAction;
class QWidget;

namespace nearfit::ui {

class Reporter;
class SceneWork;
class Selection;

/// Exports the scene's placements and meshes: asks what and where to, writes it in another thread; copies a
/// pose to the clipboard. Also has the command for reports.
class Exporter : public QObject {
  Q_OBJECT

 public:
  /// Returns the moving part's worldFromPart now; anything if there is none.
  using PoseOfMoving = std::function<RigidTransform()>;

  /// @param session, selection, work  Outlive this.
  /// @param window                    The parent, and that of dialogs.
  Exporter(Session& session, const Selection& selection, const SceneWork& work, PoseOfMoving poseOfMoving,
           QWidget* window);
  ~Exporter() override;

  /// Returns the action that asks what to export and writes it.
  QAction* exportAction() const noexcept { return export_; }
  /// Asks the same, and offers a map of clearance.
  void exportMap();
  /// Returns the action that copies the current part's pose as a matrix (matrixText()); the moving part's if
  /// none is selected.
  QAction* copyAction() const noexcept { return copy_; }
  /// Returns the action that writes a report of the scene.
  QAction* reportAction() const noexcept;

 signals:
  /// Emitted before an export: numbers that are still being typed count now.
  void sceneNeeded();
  /// Emitted when something failed that the user must see.
  void failed(const nearfit::ui::Failure& failure);
  /// Emitted with a short note for the status bar.
  void noted(const QString& text);

 private:
  void updateActions();
  /// No-op while something is being written.
  /// @param kind  Offered at first; nullopt: the one exported last.
  void askAndExport(std::optional<ExportKind> kind = std::nullopt);
  void copyPlacement();
  void write(const SceneExport& what, const QString& file);

  Session& session_;
  const Selection& selection_;
  const SceneWork& work_;
  const PoseOfMoving poseOfMoving_;
  QWidget* window_;
  QAction *export_, *copy_;
  Reporter* reporter_;
  BackgroundTask task_;
  Subscription changes_;
};

}  // namespace nearfit::ui
