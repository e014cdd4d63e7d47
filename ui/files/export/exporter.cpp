#include "ui/files/export/exporter.h"

#include <QAction>
#include <QApplication>
#include <QClipboard>
#include <QFileInfo>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/report/placement_table.h"
#include "ui/files/export/export_dialog.h"
#include "ui/files/export/reporter.h"
#include "ui/model/scene_work.h"
#include "ui/model/selection.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/progress_dialog.h"
#include "ui/widgets/save_file.h"

namespace nearfit::ui {
namespace {

/// Returns "placement", "clearance-map", "clearance-histogram" or, for meshes and assemblies, the scene's name or "parts".
QString nameFor(const Session& session, ExportKind kind) {
  if (kind == ExportKind::ClearanceMapPly) return QStringLiteral("clearance-map");
  if (kind == ExportKind::ClearanceHistogramCsv) return QStringLiteral("clearance-histogram");
  if (!hasChosenParts(kind)) return QStringLiteral("placement");
  return session.file().empty() ? QStringLiteral("parts") : fromPath(session.file().stem());
}

}  // namespace

Exporter::Exporter(Session& session, const Selection& selection, const SceneWork& work,
                   PoseOfMoving poseOfMoving, QWidget* window)
    : QObject(window),
      session_(session),
      selection_(selection),
      work_(work),
      poseOfMoving_(std::move(poseOfMoving)),
      window_(window),
      export_(makeAction(this, "exportPlacement", tr("&Export…"), QStringLiteral("export"),
                         QStringLiteral("Ctrl+E"),
                         tr("Export the poses of the parts (JSON, CSV), the parts as one mesh or as an "
                            "assembly, or a map of "
                            "clearance"))),
      copy_(makeAction(this, "copyPlacement", tr("&Copy placement"), QStringLiteral("copy"),
                       QStringLiteral("Ctrl+Shift+C"))),
      reporter_(new Reporter(session_, work_, poseOfMoving_, window_, this)) {
  setHelp(*copy_, tr("Copy the selected part's placement as a 4x4 matrix by rows, in metres"));
  connect(export_, &QAction::triggered, this, [this] {
    emit sceneNeeded();
    askAndExport();
  });
  connect(copy_, &QAction::triggered, this, &Exporter::copyPlacement);
  connect(reporter_, &Reporter::sceneNeeded, this, &Exporter::sceneNeeded);
  connect(reporter_, &Reporter::failed, this, &Exporter::failed);
  connect(reporter_, &Reporter::noted, this, &Exporter::noted);
  connect(&work_, &SceneWork::busyChanged, this, &Exporter::updateActions);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { updateActions(); });
  updateActions();
}

Exporter::~Exporter() = default;

QAction* Exporter::reportAction() const noexcept {
  return reporter_->action();
}

void Exporter::updateActions() {
  export_->setEnabled(!work_.isBusy() && !session_.scene().parts().empty());
}

void Exporter::exportMap() {
  if (!export_->isEnabled()) return;
  emit sceneNeeded();
  askAndExport(ExportKind::ClearanceMapPly);
}

void Exporter::askAndExport(std::optional<ExportKind> kind) {
  if (task_.isRunning() || session_.scene().parts().empty()) return;
  ExportDialog dialog(placedScene(session_.scene(), poseOfMoving_()), selection_.parts(), window_, kind);
  if (dialog.exec() != QDialog::Accepted) return;
  const SceneExport what = dialog.choice();
  const QString suffix =
      QString::fromLatin1(extensionOf(what.kind).data(), static_cast<int>(extensionOf(what.kind).size()));
  const std::optional<QString> file =
      askForSave({tr("Export"),
                  Preferences::lastFolder() + QChar('/') + nameFor(session_, what.kind) + QChar('.') + suffix,
                  {tr("%1 files (*.%2)").arg(suffix.toUpper(), suffix)},
                  {suffix}},
                 window_);
  if (file) write(what, *file);
}

void Exporter::write(const SceneExport& what, const QString& file) {
  // Set by the job, and read once it has ended.
  const auto notes = std::make_shared<std::vector<std::string>>();
  const auto job = [scene = session_.scene(), pose = poseOfMoving_(), what, path = toPath(file),
                    notes](const ProgressCallback& progress) {
    *notes = exportScene(scene, pose, what, path, progress);
  };
  const QString name = QFileInfo(file).fileName();
  const auto done = [this, file, name, notes](const std::exception_ptr& error) {
    if (isCancelled(error)) return;
    if (error) {
      emit failed(describe(tr("Nothing was exported."), error));
      return;
    }
    Preferences::rememberFolderOf(file);
    QString text = tr("Exported %1").arg(name);
    if (!notes->empty()) text += QStringLiteral(". ") + QString::fromStdString(notes->front());
    if (notes->size() > 1) text += tr(" (and %1 more)").arg(notes->size() - 1);
    emit noted(text);
  };
  runWithDialog(task_, tr("Writing"), tr("Writing %1").arg(name), window_, job, done);
}

void Exporter::copyPlacement() {
  const Scene& scene = session_.scene();
  const std::optional<PartId> current = selection_.current();
  const std::optional<PartId> id = current ? current : scene.movingPart();
  const Part* part = id ? scene.find(*id) : nullptr;
  if (part == nullptr) {
    emit noted(tr("Select the part whose placement you want to copy."));
    return;
  }
  const RigidTransform pose =
      scene.isMoving(*id) ? placedScene(scene, poseOfMoving_()).get(*id).worldFromPart : part->worldFromPart;
  QApplication::clipboard()->setText(QString::fromStdString(matrixText(pose)));
  emit noted(tr("Copied the placement of %1: a 4x4 matrix by rows, in metres")
                 .arg(QString::fromStdString(part->name)));
}

}  // namespace nearfit::ui
