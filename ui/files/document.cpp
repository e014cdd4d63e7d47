#include "ui/files/document.h"

#include <QFileDialog>
#include <QFileInfo>
#include <QMessageBox>
#include <QPushButton>
#include <algorithm>
#include <chrono>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/math/aabb.h"
#include "core/mesh/mesh_builder.h"
#include "core/parallel/low_priority.h"
#include "core/scene/document_parts.h"
#include "core/scene/moving_body.h"
#include "core/scene/scene_file.h"
#include "core/scene/scene_tree.h"
#include "ui/files/dropped_files.h"
#include "ui/files/import_tessellation.h"
#include "ui/files/recent_files.h"
#include "ui/files/unit_dialog.h"
#include "ui/widgets/names.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/preferences.h"
#include "ui/widgets/progress_dialog.h"
#include "ui/widgets/save_file.h"

namespace nearfit::ui {
namespace {

/// Between pictures that show more shapes instead of boxes: some of them a second, and time for the making.
constexpr std::chrono::milliseconds kBetweenShapes{200};

/// After a document has been loaded, and after the next work that a dialog shows has begun, until shapes are made instead of
/// boxes. Hierarchies of a million triangles come from the cache within it, if they have the processors to themselves; where
/// work takes longer, boxes should not stay for all of it.
constexpr std::chrono::milliseconds kBeforeShapes{300};

/// Share of loading spent on reading; the rest builds shapes.
constexpr double kReading = 0.9;

/// Where no file is without a unit, it is not used [m].
constexpr double kAnyUnit = 1e-3;

const QString kSceneSuffix = QStringLiteral("nearfit");

QString partFilter() {
  const QString meshes = meshPatterns().join(' '), documents = documentPatterns().join(' ');
  return QObject::tr("Parts (%1 %2);;Meshes (%1);;CAD documents (%2);;All files (*)").arg(meshes, documents);
}

QString sceneFilter() {
  return QObject::tr("Nearfit scenes (*.%1)").arg(kSceneSuffix);
}

QString openFilter() {
  const QString all = QObject::tr("Scenes and parts (*.%1 %2 %3)")
                          .arg(kSceneSuffix, meshPatterns().join(' '), documentPatterns().join(' '));
  return all + QStringLiteral(";;") + sceneFilter() + QStringLiteral(";;") + partFilter();
}

/// The files that store no unit.
QStringList withoutUnit(const QStringList& files) {
  QStringList without;
  for (const QString& file : files) {
    if (!storesUnit(toPath(file))) without << file;
  }
  return without;
}

/// Says in which condition the worst of several meshes are.
/// @param meshes  Their number by condition; one has a warning.
QString conditionText(const std::map<MeshCondition, int>& meshes) {
  const auto& [condition, count] = *meshes.rbegin();
  const bool isOne = count == 1;
  switch (condition) {
    case MeshCondition::Open:
      return isOne ? Document::tr("A mesh is open or degenerate: see its tooltip in the list of parts")
                   : Document::tr("%1 meshes are open or degenerate: see their tooltips in the list of parts")
                         .arg(count);
    case MeshCondition::Doubtful:
      return isOne ? Document::tr("A mesh may not be whole: see its tooltip in the list of parts")
                   : Document::tr("%1 meshes may not be whole: see their tooltips in the list of parts")
                         .arg(count);
    case MeshCondition::Mended:
    case MeshCondition::Sound:
      break;
  }
  return isOne ? Document::tr("Mended on loading: see the mesh's tooltip in the list of parts")
               : Document::tr("Mended on loading: %1 meshes, see their tooltips in the list of parts")
                     .arg(count);
}

/// Box around all parts of a scene that have a mesh, in the world.
Aabb boxOf(const Scene& scene) {
  Aabb box;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (part->geometry == nullptr) continue;
    const Aabb& own = part->geometry->mesh.bounds();
    for (int corner = 0; !own.isEmpty() && corner < 8; ++corner) {
      const glm::dvec3 p((corner & 1) != 0 ? own.upper.x : own.lower.x,
                         (corner & 2) != 0 ? own.upper.y : own.lower.y,
                         (corner & 4) != 0 ? own.upper.z : own.lower.z);
      box.add(part->worldFromPart.applyToPoint(p));
    }
  }
  return box;
}

/// Hints of a scene about the unit of files that are added to it.
UnitHints hintsOf(const Scene& scene) {
  UnitHints hints;
  const Aabb box = boxOf(scene);
  if (box.isEmpty()) return hints;
  hints.scene = box.upper - box.lower;
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const Scene::PartPtr& part : scene.parts()) {
    const double size = part->geometry != nullptr ? part->geometry->mesh.bounds().diagonal() : 0.0;
    if (!(size > 0.0)) continue;
    least = std::min(least, size);
    most = std::max(most, size);
  }
  if (most > 0.0) {
    hints.leastSize = least;
    hints.mostSize = most;
  }
  return hints;
}

QStringList foldersOf(const QStringList& files) {
  QStringList folders;
  for (const QString& file : files)
    folders << QFileInfo(file).absolutePath();
  folders.removeDuplicates();
  return folders;
}

/// Extensions, as in ".stl".
QStringList typesOf(const QStringList& files) {
  const QString packed = QStringLiteral(".gz");
  QStringList types;
  for (const QString& file : files) {
    const QString lowered = file.toLower();
    const QString plain = lowered.endsWith(packed) ? lowered.chopped(packed.size()) : lowered;
    types << QStringLiteral(".") + QFileInfo(plain).suffix();
  }
  types.removeDuplicates();
  return types;
}

/// Stands for a file name in a failure that concerns all files.
QString nameOfAll(const QStringList& files) {
  return files.size() == 1 ? QFileInfo(files.first()).fileName() : QObject::tr("All files");
}

/// Says which files could not be loaded, and what became of the scene.
/// @param isAny  Parts of others have come.
/// @param isNew  Of a new scene, else of the open one.
Failure notLoaded(const QStringList& files, QVector<FailedItem> problems, bool isAny, bool isNew) {
  for (FailedItem& problem : problems) {
    if (problem.remedy.isEmpty())
      problem.remedy = QObject::tr("Try to open it in the program that wrote it, and export it again.");
  }
  QString others = isNew ? QObject::tr("The open scene stays.") : QObject::tr("Nothing was added.");
  if (isAny)
    others = isNew ? QObject::tr("The others make up the new scene.") : QObject::tr("The others were added.");
  QString which;
  if (files.size() == 1)
    which = QObject::tr("“%1” could not be loaded.").arg(nameOfAll(files));
  else if (!isAny)
    which = QObject::tr("None of %1 files could be loaded.").arg(files.size());
  else if (problems.size() == 1)
    which = QObject::tr("“%1”, one of %2 files, could not be loaded.")
                .arg(problems.first().name)
                .arg(files.size());
  else
    which = QObject::tr("%1 of %2 files could not be loaded.").arg(problems.size()).arg(files.size());
  return describeItems(which + ' ' + others, problems);
}

}  // namespace

ProgressCallback progressOfReading(const ProgressCallback& whole) {
  return [whole](double fraction) { return !whole || whole(kReading * fraction); };
}

ProgressCallback progressOfShapes(const ProgressCallback& whole) {
  return [whole](double fraction) { return !whole || whole(kReading + (1.0 - kReading) * fraction); };
}

Document::Document(Session& session, std::shared_ptr<PartShapeCache> shapes, QWidget* window)
    : session_(session), shapes_(std::move(shapes)), window_(window) {
  // Each time all that has been made is shown, and that is a picture to draw.
  shaped_.setSingleShot(true);
  shaped_.setInterval(kBetweenShapes);
  connect(&shaping_, &BackgroundTask::progressed, this, [this] {
    if (!shaped_.isActive()) shaped_.start();
  });
  connect(&shaped_, &QTimer::timeout, this, &Document::shapesMade);
  shapesWait_.setSingleShot(true);
  shapesWait_.setInterval(kBeforeShapes);
  connect(&shapesWait_, &QTimer::timeout, this, &Document::makePostponedShapes);
}

Document::~Document() = default;

void Document::load(const QString& title, const QString& text, BackgroundTask::Job job,
                    std::function<void(std::exception_ptr)> done) {
  const auto ended = [this, done = std::move(done)](const std::exception_ptr& error) {
    emit busyChanged();
    done(error);
    shapesWait_.start();
    prepareNext();
  };
  const auto behindTheView = [job = std::move(job)](const ProgressCallback& progress) {
    // The window's pictures, which software OpenGL draws on all processors, come first; the importer inherits this too.
    lowerThreadPriority();
    job(progress);
  };
  shaping_.cancel();
  shapesWait_.start();
  runWithDialog(task_, title, text, window_, behindTheView, ended);
  emit busyChanged();
}

void Document::makePostponedShapes() {
  if (shaping_.isRunning() || !shapes_->hasPostponed()) return;
  const auto job = [shapes = shapes_](const ProgressCallback& progress) {
    // The view goes on drawing meanwhile.
    lowerThreadPriority();
    shapes->makePostponed(progress);
  };
  shaping_.run(job, [this](const std::exception_ptr& error) {
    // It starts again, and then shows what this one has made as well.
    if (isCancelled(error)) return;
    shaped_.stop();
    emit shapesMade();
    if (error) return emit failed(describe(tr("Some parts cannot be drawn."), error));
    makePostponedShapes();
  });
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
  load(tr("Preparing"), tr("Preparing the parts"), job, [this, answer](const std::exception_ptr& error) {
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
  if (!files.isEmpty()) openInPlace(files);
}

void Document::openScene(const QString& file) {
  if (isBusy() || !mayLeaveScene()) return;
  loadScene(file, {}, {kAnyUnit, {}});
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
  load(tr("Opening"), tr("Opening %1").arg(name), job, [=, this](const std::exception_ptr& error) {
    if (!error) {
      QStringList changed;
      for (const std::filesystem::path& mesh : read->changed)
        changed << fromPath(mesh);
      opened(std::move(read->scene), changed);
      if (!changed.isEmpty()) emit meshesHaveChanged(changed);
      return;
    }
    if (isCancelled(error))
      emit noted(tr("Opening of %1 cancelled. The open scene stays.").arg(shortName(name)));
    else
      emit failed(describe(tr("The scene could not be opened."), error));
    emit loaded(false);
  });
}

void Document::loadScene(const QString& file, const QStringList& partsAfter, const PartReading& reading) {
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
      loadParts(partsAfter, reading, Target::OpenScene);
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
      QFileDialog::getOpenFileNames(window_, tr("Add parts"), Preferences::lastFolder(), partFilter());
  if (files.isEmpty()) return;
  if (const std::optional<double> unit = unitOf(files, Target::OpenScene)) addParts(files, *unit);
}

std::optional<double> Document::unitOf(const QStringList& files, Target target) {
  const QStringList asked = withoutUnit(files);
  if (asked.isEmpty()) return kAnyUnit;
  UnitHints hints = target == Target::OpenScene ? hintsOf(session_.scene()) : UnitHints();
  const QStringList kinds = foldersOf(asked) + typesOf(asked);
  for (const QString& kind : kinds) {
    const auto chosen = chosenUnits_.find(kind);
    if (!hints.chosen && chosen != chosenUnits_.end()) hints.chosen = chosen->second;
  }
  const std::optional<double> unit = askForUnit(asked, hints, window_);
  for (const QString& kind : kinds)
    if (unit) chosenUnits_[kind] = *unit;
  return unit;
}

/// Files of parts, loaded.
struct Document::LoadedFiles {
  std::vector<PartGeometryPtr> meshes;
  std::vector<LoadedDocument> documents;
  QVector<FailedItem> problems;
  /// All that is to be drawn.
  std::vector<PartGeometryPtr> geometries() const;
};

std::vector<PartGeometryPtr> Document::LoadedFiles::geometries() const {
  std::vector<PartGeometryPtr> all = meshes;
  for (const LoadedDocument& document : documents)
    std::ranges::copy_if(document.shapes, std::back_inserter(all),
                         [](const auto& shape) { return shape != nullptr; });
  return all;
}

Document::LoadedFiles Document::loadFiles(const QStringList& files, const PartReading& reading,
                                          const ProgressCallback& progress) {
  LoadedFiles outcome;
  std::vector<MeshSource> meshes;
  std::vector<std::filesystem::path> documents;
  for (const QString& file : files) {
    const std::filesystem::path path = toPath(file);
    if (isDocumentFile(path))
      documents.push_back(path);
    else
      meshes.push_back({path, reading.metresPerUnit});
  }
  const double whole = static_cast<double>(files.size());
  double done = static_cast<double>(meshes.size());
  const std::vector<LoadedPart> loaded =
      loadPartGeometries(meshes, stageCallback(progress, 0.0, done / whole));
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    if (loaded[i].problem)
      outcome.problems << describeItem(fromPath(meshes[i].file.filename()), loaded[i].problem);
    else
      outcome.meshes.push_back(loaded[i].geometry);
  }
  for (const std::filesystem::path& file : documents) {
    try {
      outcome.documents.push_back(loadDocument(file, reading.metresPerUnit, reading.tessellation,
                                               stageCallback(progress, done / whole, (done + 1.0) / whole)));
    } catch (const Cancelled&) {
      throw;
    } catch (...) {
      outcome.problems << describeItem(fromPath(file.filename()), std::current_exception());
    }
    done += 1.0;
  }
  return outcome;
}

void Document::addParts(const QStringList& files, double metresPerUnit,
                        const std::optional<Tessellation>& tessellation) {
  loadParts(files, {metresPerUnit, tessellation ? *tessellation : importTessellation()}, Target::OpenScene);
}

void Document::loadParts(const QStringList& files, const PartReading& reading, Target target) {
  if (isBusy() || files.isEmpty()) return;
  Preferences::rememberFolderOf(files.first());
  auto outcome = std::make_shared<LoadedFiles>();
  const auto job = [outcome, files, reading, shapes = shapes_](const ProgressCallback& progress) {
    *outcome = loadFiles(files, reading, progressOfReading(progress));
    shapes->prepare(outcome->geometries(), progressOfShapes(progress));
  };
  const QString name =
      files.size() == 1 ? QFileInfo(files.first()).fileName() : tr("%n files", nullptr, files.size());
  load(tr("Loading"), tr("Loading %1").arg(name), job, [=, this](const std::exception_ptr& error) {
    if (isCancelled(error)) {
      const QString note = target == Target::NewScene ? tr("Opening of %1 cancelled. The open scene stays.")
                                                      : tr("Loading of %1 cancelled. Nothing was added.");
      emit noted(note.arg(shortName(name)));
      emit loaded(false);
      return;
    }
    if (error) outcome->problems << describeItem(nameOfAll(files), error);
    finishParts(files, *outcome, target);
  });
}

void Document::tellWarnings(const LoadedFiles& files) {
  QStringList warnings;
  std::map<MeshCondition, int> meshes;
  for (const PartGeometryPtr& geometry : files.geometries()) {
    ++meshes[conditionOf(geometry->mesh, geometry->report)];
    for (const std::string& text : geometry->report.warnings)
      warnings << fromPath(geometry->file.filename()) + QStringLiteral(": ") + QString::fromStdString(text);
  }
  // The status bar would cut several off and soon clear them; the part list keeps them.
  if (warnings.size() > 1)
    emit noted(conditionText(meshes));
  else if (warnings.size() == 1)
    emit noted(warnings.first());
  QVector<FailedItem> said;
  for (const LoadedDocument& document : files.documents) {
    for (const std::string& text : document.warnings)
      said << FailedItem{fromPath(document.file.filename()), QString::fromStdString(text), {}, {}};
  }
  // Something of a document is missing: nobody may overlook that.
  if (!said.isEmpty()) emit failed(describeItems(tr("The document was added, but not all of it."), said));
}

std::vector<PartId> Document::place(const NewNodes& nodes, Target target) {
  if (target == Target::OpenScene) {
    const SceneNodes top = session_.addNodes(nodes);
    return partsOf(session_.scene(), top);
  }
  // Files of which nothing can be read leave the open scene alone.
  if (nodes.parts.empty()) return {};
  Scene scene;
  const SceneNodes top = addTo(scene, nodes);
  // It has no file yet.
  session_.restore(std::move(scene), {});
  return partsOf(session_.scene(), top);
}

void Document::finishParts(const QStringList& files, const LoadedFiles& loadedFiles, Target target) {
  const Scene empty;
  const Scene& scene = target == Target::NewScene ? empty : session_.scene();
  QVector<FailedItem> problems = loadedFiles.problems;
  NewNodes nodes;
  for (const PartGeometryPtr& geometry : loadedFiles.meshes)
    nodes.parts.push_back({geometry, fromPath(geometry->file.stem()).toStdString()});
  for (const LoadedDocument& document : loadedFiles.documents) {
    try {
      nodes.append(partsOfDocument(document, scene));
    } catch (...) {
      problems << describeItem(fromPath(document.file.filename()), std::current_exception());
    }
  }
  std::vector<PartId> added;
  try {
    added = place(nodes, target);
  } catch (...) {
    problems << describeItem(nameOfAll(files), std::current_exception());
  }
  tellWarnings(loadedFiles);
  if (!problems.isEmpty())
    emit failed(notLoaded(files, problems, !added.empty(), target == Target::NewScene));
  if (!added.empty()) emit partsAdded(added);
  emit loaded(problems.isEmpty());
}

void Document::openFiles(const QStringList& filesAndFolders, std::optional<double> metresPerUnit,
                         const std::optional<Tessellation>& tessellation) {
  const DroppedFiles sorted = sortOut(filesAndFolders);
  const bool isLoadable = sorted.scenes.size() <= 1 && !sorted.isCutOff;
  if (!metresPerUnit && isLoadable && !sorted.meshes.isEmpty()) {
    metresPerUnit = unitOf(sorted.meshes, sorted.scenes.isEmpty() ? Target::OpenScene : Target::NewScene);
    if (!metresPerUnit) return emit loaded(false);
  }
  open(sorted, {metresPerUnit.value_or(kAnyUnit), tessellation ? *tessellation : importTessellation()});
}

void Document::openInPlace(const QStringList& filesAndFolders) {
  if (isBusy()) return;
  const DroppedFiles sorted = sortOut(filesAndFolders);
  // With a scene among them, the others are added to that one.
  if (sorted.isCutOff || !sorted.scenes.isEmpty() || sorted.meshes.isEmpty())
    return openFiles(filesAndFolders);
  if (!mayLeaveScene()) return;
  const std::optional<double> unit = unitOf(sorted.meshes, Target::NewScene);
  if (!unit) return emit loaded(false);
  loadParts(sorted.meshes, {*unit, importTessellation()}, Target::NewScene);
}

void Document::dropFiles(const QStringList& filesAndFolders) {
  if (isBusy()) return emit noted(tr("Files are still loading. Drop these again when they are done."));
  openFiles(filesAndFolders);
}

void Document::open(const DroppedFiles& files, const PartReading& reading) {
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
    if (!isBusy() && mayLeaveScene()) loadScene(files.scenes.first(), files.meshes, reading);
  } else if (files.meshes.isEmpty()) {
    emit loaded(false);
  } else {
    loadParts(files.meshes, reading, Target::OpenScene);
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
