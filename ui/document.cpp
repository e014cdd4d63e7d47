#include "ui/document.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <utility>

#include "core/error.h"
#include "core/report/placement_export.h"
#include "core/scene/scene_file.h"
#include "ui/dialogs/progress_dialog.h"
#include "ui/dialogs/unit_dialog.h"
#include "ui/paths.h"
#include "ui/preferences.h"

namespace nearfit::ui {
namespace {

const QString kSceneSuffix = QStringLiteral("nearfit");

QString meshFilter() {
  QStringList patterns;
  for (const std::string& extension : importableExtensions()) {
    const QString suffix = QString::fromStdString(extension);
    patterns << QStringLiteral("*.") + suffix << QStringLiteral("*.") + suffix.toUpper();
  }
  return QObject::tr("Meshes (%1);;All files (*)").arg(patterns.join(' '));
}

QString sceneFilter() {
  return QObject::tr("Nearfit scenes (*.%1)").arg(kSceneSuffix);
}

bool isScene(const QString& file) {
  return QFileInfo(file).suffix().toLower() == kSceneSuffix;
}

bool isCancelled(const std::exception_ptr& error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const Cancelled&) {
    return true;
  } catch (...) {
  }
  return false;
}

}  // namespace

Document::Document(Session& session, std::shared_ptr<PartShapeCache> shapes, QWidget* window)
    : session_(session), shapes_(std::move(shapes)), window_(window) {}

Document::~Document() = default;

void Document::load(const QString& text, BackgroundTask::Job job,
                    std::function<void(std::exception_ptr)> done) {
  progress_ = new ProgressDialog(text, window_);
  connect(&task_, &BackgroundTask::progressed, progress_, &ProgressDialog::setFraction);
  connect(progress_, &ProgressDialog::cancelled, &task_, &BackgroundTask::cancel);
  task_.run(std::move(job), [this, done = std::move(done)](const std::exception_ptr& error) {
    delete progress_;
    emit busyChanged();
    done(error);
    prepareNext();
  });
  emit busyChanged();
}

void Document::prepareHierarchies(std::function<void(bool)> done) {
  waiting_.push_back(std::move(done));
  prepareNext();
}

void Document::prepareNext() {
  if (isBusy() || waiting_.empty()) return;
  const auto answer = [this](bool isReady) {
    for (const auto& done : std::exchange(waiting_, {}))
      done(isReady);
  };
  const std::vector<PartGeometryPtr> geometries = session_.scene().geometries();
  if (areHierarchiesReady(geometries)) {
    answer(true);
    return;
  }
  const auto job = [geometries](const ProgressCallback& progress) {
    nearfit::prepareHierarchies(geometries, progress);
  };
  load(tr("Preparing the parts to be felt"), job, [this, answer](const std::exception_ptr& error) {
    if (error && !isCancelled(error)) emit failed(describe(tr("The parts could not be prepared."), error));
    answer(!error);
  });
}

bool Document::mayLeaveScene() {
  emit sceneNeeded();
  if (!session_.isModified()) return true;
  QMessageBox box(QMessageBox::Question, tr("Nearfit"), tr("The scene has changes that are not saved."),
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, window_);
  box.setObjectName(QStringLiteral("unsavedBox"));
  box.setInformativeText(tr("Save them before they are lost?"));
  box.setDefaultButton(QMessageBox::Save);
  switch (box.exec()) {
    case QMessageBox::Save:
      return save();
    case QMessageBox::Discard:
      return true;
    default:
      return false;
  }
}

void Document::newScene() {
  if (mayLeaveScene()) session_.reset();
}

void Document::askAndOpen() {
  const QString file =
      QFileDialog::getOpenFileName(window_, tr("Open scene"), Preferences::lastFolder(), sceneFilter());
  if (!file.isEmpty()) openScene(file);
}

void Document::openScene(const QString& file) {
  if (isBusy() || !mayLeaveScene()) return;
  loadScene(file, {});
}

void Document::loadScene(const QString& file, const QStringList& partsAfter) {
  Preferences::rememberFolderOf(file);
  auto scene = std::make_shared<Scene>();
  const auto job = [scene, shapes = shapes_, path = toPath(file)](const ProgressCallback& progress) {
    *scene = readSceneFile(path, progress);
    for (const Scene::PartPtr& part : scene->parts())
      shapes->shapeOf(part->geometry);
  };
  load(tr("Opening %1").arg(QFileInfo(file).fileName()), job, [=, this](const std::exception_ptr& error) {
    if (error) {
      if (!isCancelled(error)) emit failed(describe(tr("The scene could not be opened."), error));
      emit loaded(false);
      return;
    }
    session_.reset(std::move(*scene), toPath(file));
    if (!partsAfter.isEmpty()) {
      addParts(partsAfter, Preferences::metresPerUnit());
      return;
    }
    emit noted(tr("Opened %1").arg(QFileInfo(file).fileName()));
    emit loaded(true);
  });
}

void Document::askAndAddParts() {
  const QStringList files =
      QFileDialog::getOpenFileNames(window_, tr("Add parts"), Preferences::lastFolder(), meshFilter());
  if (files.isEmpty()) return;
  const QString what = files.size() == 1 ? tr("“%1”").arg(QFileInfo(files.first()).fileName())
                                         : tr("what these %n files hold", nullptr, files.size());
  if (const std::optional<double> unit = askForUnit(what, window_)) addParts(files, *unit);
}

void Document::addParts(const QStringList& files, double metresPerUnit) {
  if (isBusy() || files.isEmpty()) return;
  Preferences::rememberFolderOf(files.first());
  struct Outcome {
    std::vector<PartGeometryPtr> geometries;
    QStringList problems;
  };
  auto outcome = std::make_shared<Outcome>();
  const auto job = [outcome, files, metresPerUnit, shapes = shapes_](const ProgressCallback& progress) {
    std::vector<MeshSource> sources;
    for (const QString& file : files)
      sources.push_back({toPath(file), metresPerUnit, {}});
    for (const LoadedPart& loaded : loadPartGeometries(sources, progress)) {
      if (loaded.problem) {
        outcome->problems << describe({}, loaded.problem).details;
      } else {
        outcome->geometries.push_back(loaded.geometry);
        shapes->shapeOf(loaded.geometry);
      }
    }
  };
  const QString text = files.size() == 1 ? tr("Loading %1").arg(QFileInfo(files.first()).fileName())
                                         : tr("Loading %n files", nullptr, files.size());
  load(text, job, [this, outcome](const std::exception_ptr& error) {
    if (isCancelled(error)) {
      emit loaded(false);
      return;
    }
    if (error) outcome->problems << describe({}, error).details;
    finishParts(outcome->geometries, outcome->problems);
  });
}

void Document::finishParts(const std::vector<PartGeometryPtr>& geometries, const QStringList& problems) {
  QStringList warnings;
  for (const PartGeometryPtr& geometry : geometries) {
    session_.addPart(geometry, geometry->file.stem().string());
    for (const std::string& warning : geometry->report.warnings) {
      warnings << fromPath(geometry->file.filename()) + QStringLiteral(": ") +
                      QString::fromStdString(warning);
    }
  }
  if (!warnings.isEmpty()) emit noted(warnings.join(QStringLiteral("  ")));
  if (!problems.isEmpty()) {
    const QString summary = problems.size() == 1
                                ? tr("A part could not be loaded.")
                                : tr("%n parts could not be loaded.", nullptr, problems.size());
    emit failed({summary, problems.join(QStringLiteral("\n\n"))});
  }
  emit loaded(problems.isEmpty());
}

void Document::openFiles(const QStringList& files) {
  QStringList scenes, meshes;
  for (const QString& file : files)
    (isScene(file) ? scenes : meshes) << file;
  if (scenes.size() > 1) {
    emit failed({tr("Only one scene can be open."), tr("Give one .nearfit file; parts can be added to it.")});
    emit loaded(false);
  } else if (scenes.size() == 1) {
    if (!isBusy() && mayLeaveScene()) loadScene(scenes.first(), meshes);
  } else {
    addParts(meshes, Preferences::metresPerUnit());
  }
}

bool Document::save() {
  if (session_.file().empty()) return askAndSaveAs();
  return saveTo(fromPath(session_.file()));
}

bool Document::askAndSaveAs() {
  const QString start = session_.file().empty() ? Preferences::lastFolder() + QStringLiteral("/scene.nearfit")
                                                : fromPath(session_.file());
  QFileDialog dialog(window_, tr("Save scene"), start, sceneFilter());
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(kSceneSuffix);
  if (dialog.exec() != QDialog::Accepted) return false;
  return saveTo(dialog.selectedFiles().first());
}

bool Document::saveTo(const QString& file) {
  emit sceneNeeded();
  try {
    session_.save(toPath(file));
  } catch (...) {
    emit failed(describe(tr("The scene could not be saved."), std::current_exception()));
    return false;
  }
  Preferences::rememberFolderOf(file);
  emit noted(tr("Saved %1").arg(QFileInfo(file).fileName()));
  return true;
}

void Document::askAndExport(const RigidTransform& worldFromMoving) {
  QFileDialog dialog(window_, tr("Export placement"),
                     Preferences::lastFolder() + QStringLiteral("/placement.json"), tr("Placement (*.json)"));
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("json"));
  if (dialog.exec() != QDialog::Accepted) return;
  const QString file = dialog.selectedFiles().first();
  try {
    exportPlacement(session_.scene(), worldFromMoving, toPath(file));
  } catch (...) {
    emit failed(describe(tr("The placement could not be exported."), std::current_exception()));
    return;
  }
  Preferences::rememberFolderOf(file);
  emit noted(tr("Exported %1").arg(QFileInfo(file).fileName()));
}

}  // namespace nearfit::ui
