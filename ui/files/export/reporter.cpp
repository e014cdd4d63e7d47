#include "ui/files/export/reporter.h"

#include <QAction>
#include <QDialog>
#include <QFileInfo>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "core/parallel/low_priority.h"
#include "core/report/html/fit_report.h"
#include "core/report/mesh_export.h"
#include "ui/files/export/report_dialog.h"
#include "ui/model/scene_work.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/progress_dialog.h"
#include "ui/widgets/save_file.h"

namespace nearfit::ui {
namespace {

/// Input of a report, for another thread.
struct ReportWork {
  Scene scene;
  std::filesystem::path sceneFile, path, certificate, target;
  double threshold = 0.0;  ///< [m]
  std::size_t pictures = kDefaultPicturedFindings;
  bool isAsSaved = false;  ///< The scene is what its file holds.
};

/// Hash of the scene's file; empty if there is none that holds the scene.
std::string savedHash(const ReportWork& work) {
  if (!work.isAsSaved) return {};
  try {
    return sha256OfFile(work.sceneFile);
  } catch (const FileError&) {
    // It was moved away or deleted: what is open is not saved then.
    return {};
  }
}

FitReportOutcome makeReport(const ReportWork& work, const ProgressCallback& progress) {
  lowerThreadPriority();
  FitReportRequest request = fitReportRequest(work.scene, work.sceneFile, savedHash(work), work.threshold);
  request.maxPictured = work.pictures;
  if (!work.path.empty()) addPath(request, work.path);
  if (!work.certificate.empty()) addCertificate(request, work.certificate);
  return writeFitReport(request, work.target, progress);
}

}  // namespace

Reporter::Reporter(Session& session, const SceneWork& work, PoseOfMoving poseOfMoving, QWidget* window,
                   QObject* parent)
    : QObject(parent),
      session_(session),
      work_(work),
      poseOfMoving_(std::move(poseOfMoving)),
      window_(window),
      action_(makeAction(
          this, "report", tr("Repor&t…"), {}, {},
          tr("Check all pairs of parts and write the verdict with pictures, tables and hashes as one HTML "
             "file, to be read in a browser and printed"))) {
  connect(action_, &QAction::triggered, this, [this] {
    emit sceneNeeded();
    askAndWrite();
  });
  connect(&work_, &SceneWork::busyChanged, this, &Reporter::updateAction);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { updateAction(); });
  updateAction();
}

Reporter::~Reporter() = default;

void Reporter::updateAction() {
  action_->setEnabled(!work_.isBusy() && !session_.scene().parts().empty());
}

Scene Reporter::presentScene() const {
  const Scene& scene = session_.scene();
  if (!scene.movingPart()) return scene;
  const RigidTransform pose = poseOfMoving_();
  // A pose that is normalised again may differ in its last bit, which a certificate would notice.
  return pose == scene.get(*scene.movingPart()).worldFromPart ? scene : placedScene(scene, pose);
}

bool Reporter::isAsSaved() const {
  const Scene& scene = session_.scene();
  const bool isMoved = scene.movingPart() && poseOfMoving_() != scene.get(*scene.movingPart()).worldFromPart;
  return !session_.file().empty() && !session_.isModified() && !isMoved;
}

void Reporter::askAndWrite() {
  if (task_.isRunning() || session_.scene().parts().empty()) return;
  ReportDialog dialog(Preferences::checkThreshold(), window_);
  if (dialog.exec() != QDialog::Accepted) return;
  const QString name = session_.file().empty() ? QStringLiteral("report") : fromPath(session_.file().stem());
  const std::optional<QString> file =
      askForSave({tr("Report"),
                  Preferences::lastFolder() + QChar('/') + name + QStringLiteral(".html"),
                  {tr("Web pages (*.html *.htm)")},
                  {QStringLiteral("html"), QStringLiteral("htm")}},
                 window_);
  if (file) write(dialog, *file);
}

void Reporter::write(const ReportDialog& dialog, const QString& file) {
  const ReportWork work{
      presentScene(), session_.file(),    toPath(dialog.pathFile()), toPath(dialog.certificateFile()),
      toPath(file),   dialog.threshold(), dialog.pictures(),         isAsSaved()};
  // Set by the job, and read once it has ended.
  const auto outcome = std::make_shared<FitReportOutcome>();
  const auto job = [work, outcome](const ProgressCallback& progress) {
    *outcome = makeReport(work, progress);
  };
  const QString name = QFileInfo(file).fileName();
  const auto done = [this, file, name, outcome](const std::exception_ptr& error) {
    if (isCancelled(error)) return;
    if (error) {
      emit failed(describe(tr("No report was written."), error));
      return;
    }
    Preferences::rememberFolderOf(file);
    emit noted(tr("Wrote %1. %2").arg(name, QString::fromStdString(outcome->sentence)));
  };
  runWithDialog(task_, tr("Report"), tr("Writing %1").arg(name), window_, job, done);
}

}  // namespace nearfit::ui
