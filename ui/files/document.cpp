#include "ui/files/document.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QPushButton>
#include <utility>

#include "core/base/error.h"
#include "core/scene/moving_body.h"
#include "core/scene/scene_file.h"
#include "ui/files/dropped_files.h"
#include "ui/files/recent_files.h"
#include "ui/files/unit_dialog.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/progress_dialog.h"
#include "ui/widgets/save_file.h"

namespace nearfit::ui {
namespace {

constexpr double kReading = 0.45;  ///< Share of loading spent on reading; the rest builds shapes.

const QString kSceneSuffix = QStringLiteral("nearfit");

QString meshPatterns() {
  QStringList patterns;
  for (const std::string& extension : importableExtensions()) {
    const QString suffix = QString::fromStdString(extension);
    patterns << QStringLiteral("*.") + suffix << QStringLiteral("*.") + suffix.toUpper();
  }
  return patterns.join(' ');
}

QString meshFilter() {
  return QObject::tr("Meshes (%1);;All files (*)").arg(meshPatterns());
}

QString sceneFilter() {
  return QObject::tr("Nearfit scenes (*.%1)").arg(kSceneSuffix);
}

QString openFilter() {
  const QString both = QObject::tr("Scenes and meshes (*.%1 %2)").arg(kSceneSuffix, meshPatterns());
  return both + QStringLiteral(";;") + sceneFilter() + QStringLiteral(";;") + meshFilter();
}

/// Stands for a file name in a failure that concerns all files.
QString nameOfAll(const QStringList& files) {
  return files.size() == 1 ? QFileInfo(files.first()).fileName() : QObject::tr("All files");
}

QString notAdded(const QStringList& files, const QVector<FailedItem>& problems) {
  if (files.size() == 1) return QObject::tr("“%1” was not added.").arg(nameOfAll(files));
  if (problems.size() == 1)
    return QObject::tr("“%1”, one of %2 files, was not added.").arg(problems.first().name).arg(files.size());
  return QObject::tr("%1 of %2 files were not added.").arg(problems.size()).arg(files.size());
}

}  // namespace

ProgressCallback progressOfReading(const ProgressCallback& whole) {
  return [whole](double fraction) { return !whole || whole(kReading * fraction); };
}

ProgressCallback progressOfShapes(const ProgressCallback& whole) {
  return [whole](double fraction) { return !whole || whole(kReading + (1.0 - kReading) * fraction); };
}

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
  const Scene scene = session_.scene();
  if (isReadyToFeel(scene)) {
    answer(true);
    return;
  }
  const auto job = [scene](const ProgressCallback& progress) { prepareToFeel(scene, progress); };
  load(tr("Preparing the parts"), job, [this, answer](const std::exception_ptr& error) {
    if (error && !isCancelled(error)) emit failed(describe(tr("The parts could not be prepared."), error));
    answer(!error);
  });
}

bool Document::mayLeaveScene() {
  emit sceneNeeded();
  if (!session_.isModified()) return true;
  QMessageBox box(QMessageBox::Question, tr("Nearfit"), tr("The scene has unsaved changes."),
                  QMessageBox::Save | QMessageBox::Discard | QMessageBox::Cancel, window_);
  box.setObjectName(QStringLiteral("unsavedBox"));
  box.setInformativeText(tr("Save them first?"));
  box.setDefaultButton(QMessageBox::Save);
  // Qt's own texts have no keys.
  box.button(QMessageBox::Save)->setText(tr("&Save"));
  box.button(QMessageBox::Discard)->setText(tr("&Discard"));
  box.button(QMessageBox::Cancel)->setText(tr("&Cancel"));
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
  const QStringList files =
      QFileDialog::getOpenFileNames(window_, tr("Open"), Preferences::lastFolder(), openFilter());
  if (!files.isEmpty()) dropFiles(files);
}

void Document::openScene(const QString& file) {
  if (isBusy() || !mayLeaveScene()) return;
  loadScene(file, {}, Preferences::metresPerUnit());
}

bool Document::openExample(const QString& file) {
  if (isBusy() || !mayLeaveScene()) return false;
  const QString name = QFileInfo(file).fileName();
  readScene(file, name, [=, this](Scene scene, const QStringList&) {
    session_.reset(std::move(scene));
    emit noted(tr("Opened %1").arg(name));
    emit loaded(true);
  });
  return true;
}

void Document::readScene(const QString& file, const QString& name,
                         const std::function<void(Scene, const QStringList&)>& opened) {
  struct Outcome {
    Scene scene;
    std::vector<std::filesystem::path> changed;
  };
  auto read = std::make_shared<Outcome>();
  const auto job = [read, shapes = shapes_, path = toPath(file)](const ProgressCallback& progress) {
    read->scene = readSceneFile(path, progressOfReading(progress), &read->changed);
    shapes->prepare(read->scene.geometries(), progressOfShapes(progress));
  };
  load(tr("Opening %1").arg(name), job, [=, this](const std::exception_ptr& error) {
    if (!error) {
      QStringList changed;
      for (const std::filesystem::path& mesh : read->changed)
        changed << fromPath(mesh);
      opened(std::move(read->scene), changed);
      if (!changed.isEmpty()) emit meshesHaveChanged(changed);
      return;
    }
    if (!isCancelled(error)) emit failed(describe(tr("The scene could not be opened."), error));
    emit loaded(false);
  });
}

void Document::loadScene(const QString& file, const QStringList& partsAfter, double metresPerUnit) {
  Preferences::rememberFolderOf(file);
  readScene(file, QFileInfo(file).fileName(), [=, this](Scene scene, const QStringList& changed) {
    // Meshes that changed make the scene differ from its file: it counts as modified.
    if (changed.isEmpty())
      session_.reset(std::move(scene), toPath(file));
    else
      session_.restore(std::move(scene), toPath(file));
    RecentFiles::remember(file);
    if (!partsAfter.isEmpty()) {
      emit sceneOpened();
      addParts(partsAfter, metresPerUnit);
      return;
    }
    emit noted(tr("Opened %1").arg(QFileInfo(file).fileName()));
    emit loaded(true);
  });
}

void Document::openRecovered(const QString& journal, const std::filesystem::path& sceneFile,
                             std::function<void()> restored) {
  if (isBusy() || !mayLeaveScene()) return;
  const QString name = sceneFile.empty() ? tr("unsaved work") : fromPath(sceneFile.filename());
  readScene(journal, name, [=, this, restored = std::move(restored)](Scene scene, const QStringList&) {
    session_.restore(std::move(scene), sceneFile);
    emit loaded(true);
    restored();
  });
}

void Document::askAndAddParts() {
  const QStringList files =
      QFileDialog::getOpenFileNames(window_, tr("Add parts"), Preferences::lastFolder(), meshFilter());
  if (files.isEmpty()) return;
  if (const std::optional<double> unit = askForUnit(files, window_)) addParts(files, *unit);
}

void Document::addParts(const QStringList& files, double metresPerUnit) {
  if (isBusy() || files.isEmpty()) return;
  Preferences::rememberFolderOf(files.first());
  struct Outcome {
    std::vector<PartGeometryPtr> geometries;
    QVector<FailedItem> problems;
  };
  auto outcome = std::make_shared<Outcome>();
  const auto job = [outcome, files, metresPerUnit, shapes = shapes_](const ProgressCallback& progress) {
    std::vector<MeshSource> sources;
    for (const QString& file : files)
      sources.push_back({toPath(file), metresPerUnit, {}});
    const std::vector<LoadedPart> parts = loadPartGeometries(sources, progressOfReading(progress));
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const LoadedPart& loaded = parts[i];
      if (loaded.problem) {
        outcome->problems << describeItem(fromPath(sources[i].file.filename()), loaded.problem);
      } else {
        outcome->geometries.push_back(loaded.geometry);
      }
    }
    shapes->prepare(outcome->geometries, progressOfShapes(progress));
  };
  const QString text = files.size() == 1 ? tr("Loading %1").arg(QFileInfo(files.first()).fileName())
                                         : tr("Loading %n files", nullptr, files.size());
  load(text, job, [this, outcome, files](const std::exception_ptr& error) {
    if (isCancelled(error)) {
      emit loaded(false);
      return;
    }
    if (error) outcome->problems << describeItem(nameOfAll(files), error);
    finishParts(files, outcome->geometries, outcome->problems);
  });
}

void Document::finishParts(const QStringList& files, const std::vector<PartGeometryPtr>& geometries,
                           const QVector<FailedItem>& loadProblems) {
  QStringList warnings;
  int warned = 0;
  std::vector<Session::NewPart> parts;
  for (const PartGeometryPtr& geometry : geometries) {
    parts.push_back({geometry, fromPath(geometry->file.stem()).toStdString()});
    if (!geometry->report.warnings.empty()) ++warned;
    for (const std::string& warning : geometry->report.warnings) {
      warnings << fromPath(geometry->file.filename()) + QStringLiteral(": ") +
                      QString::fromStdString(warning);
    }
  }
  std::vector<PartId> added;
  QVector<FailedItem> problems = loadProblems;
  try {
    added = session_.addParts(parts);
  } catch (...) {
    problems << describeItem(nameOfAll(files), std::current_exception());
  }
  // The status bar would cut several off and soon clear them; the part list keeps them.
  if (warnings.size() == 1) emit noted(warnings.first());
  if (warnings.size() > 1)
    emit noted(
        (warned == 1
             ? tr("A mesh is open or degenerate: see its tooltip in the list of parts")
             : tr("%1 meshes are open or degenerate: see their tooltips in the list of parts").arg(warned)));
  if (!problems.isEmpty()) emit failed(describeItems(notAdded(files, problems), problems));
  if (!added.empty()) emit partsAdded(added);
  emit loaded(problems.isEmpty());
}

void Document::openFiles(const QStringList& filesAndFolders, std::optional<double> metresPerUnit) {
  const DroppedFiles sorted = sortOut(filesAndFolders);
  const bool isLoadable = sorted.scenes.size() <= 1 && !sorted.isCutOff;
  if (!metresPerUnit && isLoadable && !sorted.meshes.isEmpty()) {
    metresPerUnit = askForUnit(sorted.meshes, window_);
    if (!metresPerUnit) return emit loaded(false);
  }
  open(sorted, metresPerUnit.value_or(Preferences::metresPerUnit()));
}

void Document::dropFiles(const QStringList& filesAndFolders) {
  if (isBusy()) return emit noted(tr("Files are still loading. Drop these again when they are done."));
  openFiles(filesAndFolders);
}

void Document::open(const DroppedFiles& files, double metresPerUnit) {
  if (files.isCutOff) {
    emit failed({tr("There are too many files."),
                 tr("These folders contain more than %1 meshes. Drop fewer at a time.").arg(kMaxInFolders)});
    emit loaded(false);
    return;
  }
  if (!files.emptyFolders.isEmpty())
    emit noted(tr("Nothing to open in %1").arg(files.emptyFolders.join(QStringLiteral(", "))));
  if (files.scenes.size() > 1) {
    emit failed(
        {tr("Only one scene can be open."), tr("Choose one .nearfit file; you can add parts to it.")});
    emit loaded(false);
  } else if (files.scenes.size() == 1) {
    if (!isBusy() && mayLeaveScene()) loadScene(files.scenes.first(), files.meshes, metresPerUnit);
  } else if (files.meshes.isEmpty()) {
    emit loaded(false);
  } else {
    addParts(files.meshes, metresPerUnit);
  }
}

bool Document::save() {
  if (session_.file().empty()) return askAndSaveAs();
  return saveTo(fromPath(session_.file()));
}

bool Document::askAndSaveAs() {
  const QString start = session_.file().empty() ? Preferences::lastFolder() + QStringLiteral("/scene.nearfit")
                                                : fromPath(session_.file());
  const std::optional<QString> file =
      askForSave({tr("Save scene"), start, {sceneFilter()}, {kSceneSuffix}}, window_);
  return file && saveTo(*file);
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
  RecentFiles::remember(file);
  emit noted(tr("Saved %1").arg(QFileInfo(file).fileName()));
  return true;
}

}  // namespace nearfit::ui
