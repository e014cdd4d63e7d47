#include "ui/files/part_files.h"

#include <QAction>
#include <QFileInfo>
#include <QLocale>
#include <QMenu>
#include <QSet>
#include <QSettings>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/math/aabb.h"
#include "core/proximity/query/broad_phase.h"
#include "core/scene/document_load.h"
#include "core/scene/odd_size.h"
#include "core/scene/refinement.h"
#include "ui/files/document.h"
#include "ui/files/mesh_watch.h"
#include "ui/files/refine_dialog.h"
#include "ui/files/unit_dialog.h"
#include "ui/model/hand_state.h"
#include "ui/widgets/make_action.h"
#include "ui/widgets/names.h"
#include "ui/widgets/notice_bar.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

/// Diagonal from which a document in metres was probably written in millimetres: few assemblies that are fitted by hand
/// fill a hall, while 50 mm read as metres reach it [m].
constexpr double kHugeDocument = 50.0;

const QString kReloadAlways = QStringLiteral("files/reloadAlways");
const QString kReloadNotice = QStringLiteral("reload"), kRescaleNotice = QStringLiteral("rescale"),
              kOthersNotice = QStringLiteral("others");

/// Returns "a.stl, b.stl and 4 more".
QString namesOf(const QStringList& files) {
  constexpr int kNamed = 6;
  QStringList names;
  for (const QString& file : files)
    names << QFileInfo(file).fileName();
  return listOfNames(names, kNamed);
}

/// Counts triangles, of a mesh that several share once.
std::size_t trianglesOf(const std::vector<PartGeometryPtr>& geometries) {
  std::size_t count = 0;
  const std::set<PartGeometryPtr> distinct(geometries.begin(), geometries.end());
  for (const PartGeometryPtr& geometry : distinct)
    count += geometry->mesh.triangles().size();
  return count;
}

/// Returns why a part was not loaded; null if it was.
std::exception_ptr problemOf(const LoadedPart& loaded, const std::filesystem::path& file) {
  if (loaded.problem || loaded.geometry) return loaded.problem;
  return std::make_exception_ptr(
      FileError(file.string(), "it has changed since it was read", "reload it (Ctrl+R), then try again"));
}

/// Extent along each axis of what a change of the unit scales, in the units of the files: of mesh files as they are, of
/// documents that change as a whole where their parts are placed.
glm::dvec3 extentInUnits(const Scene& scene, const std::vector<PartId>& parts) {
  Aabb box;
  for (const PartId id : parts) {
    const Part* part = scene.find(id);
    if (part == nullptr || part->geometry == nullptr || part->geometry->mesh.bounds().isEmpty()) continue;
    const Aabb& own = part->geometry->mesh.bounds();
    const Aabb placed = mayBeInWrongUnit(part->geometry->file) ? boundsOf(own, part->worldFromPart) : own;
    box.add(placed.lower / part->geometry->unitOfNumbers());
    box.add(placed.upper / part->geometry->unitOfNumbers());
  }
  return box.isEmpty() ? glm::dvec3(0.0) : box.upper - box.lower;
}

/// Extent of all parts but these, in the world [m]; std::nullopt if there are none.
std::optional<glm::dvec3> extentOfOthers(const Scene& scene, const std::vector<PartId>& parts) {
  const std::set<PartId> left(parts.begin(), parts.end());
  Aabb box;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (left.contains(part->id) || part->geometry == nullptr || part->geometry->mesh.bounds().isEmpty())
      continue;
    const Aabb placed = boundsOf(part->geometry->mesh.bounds(), part->worldFromPart);
    box.add(placed.lower);
    box.add(placed.upper);
  }
  return box.isEmpty() ? std::nullopt : std::optional(box.upper - box.lower);
}

/// True if a part is in both, in different units.
bool haveOtherUnits(const std::map<PartId, PartGeometryPtr>& before,
                    const std::map<PartId, PartGeometryPtr>& after) {
  return std::ranges::any_of(after, [&](const auto& entry) {
    const auto was = before.find(entry.first);
    return was != before.end() && was->second != nullptr && entry.second != nullptr &&
           was->second->metresPerUnit != entry.second->metresPerUnit;
  });
}

/// Returns "1,000,000" or "25.4".
QString times(double factor) {
  constexpr double kFromWhole = 100.0;
  if (factor >= kFromWhole) return QLocale().toString(std::round(factor), 'f', 0);
  return QLocale().toString(factor, 'g', 3);
}

/// Returns "about 14,000".
QString about(double ratio) {
  const double power = std::pow(10.0, std::floor(std::log10(ratio)) - 1.0);
  return PartFiles::tr("about %1").arg(QLocale().toString(power * std::round(ratio / power), 'f', 0));
}

}  // namespace

PartFiles::PartFiles(const Context& context, QMenu* menu, QWidget* window, QObject* parent)
    : QObject(parent),
      session_(context.session),
      hand_(context.hand),
      document_(context.document),
      notices_(context.notices),
      window_(window),
      watch_(new MeshWatch(context.session, this)) {
  addActions(menu);
  connect(watch_, &MeshWatch::changed, this, &PartFiles::seeChange);
  connect(&document_, &Document::partsAdded, this, &PartFiles::judgeSizes);
  connect(&document_, &Document::meshesHaveChanged, this, &PartFiles::tellOfOthers);
  connect(
      &document_, &Document::busyChanged, this,
      [this] {
        if (!document_.isBusy() && !waiting_.isEmpty()) reload(std::exchange(waiting_, {}));
      },
      Qt::QueuedConnection);
}

void PartFiles::addActions(QMenu* menu) {
  reload_ = menu->addAction(icon(QStringLiteral("reload")), tr("&Reload parts from disk"));
  reload_->setObjectName(QStringLiteral("reloadParts"));
  setHelp(*reload_, tr("Read the mesh files of all parts again; poses do not change"));
  reload_->setShortcut(QKeySequence(QStringLiteral("Ctrl+R")));
  connect(reload_, &QAction::triggered, this, [this] { reload({}); });
  reloadAlways_ = menu->addAction(tr("Reload changed parts &without asking"));
  reloadAlways_->setObjectName(QStringLiteral("reloadAlways"));
  setHelp(*reloadAlways_, tr("Reload a mesh as soon as its file changes on disk"));
  reloadAlways_->setCheckable(true);
  reloadAlways_->setChecked(QSettings().value(kReloadAlways, false).toBool());
  connect(reloadAlways_, &QAction::toggled, this,
          [](bool isOn) { QSettings().setValue(kReloadAlways, isOn); });
  const auto update = [this] {
    reload_->setEnabled(!document_.isBusy() && !session_.scene().parts().empty());
  };
  connect(&document_, &Document::busyChanged, reload_, update);
  // Parts are added only after loading has ended, but removed without any loading.
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this, update] {
    update();
    // It was saved, or is another scene: nothing is left to say.
    if (!session_.isModified() || session_.sceneSerial() != sceneOfOthers_) notices_.withdraw(kOthersNotice);
    followGeometries();
  });
  update();
}

void PartFiles::seeChange(const QStringList& files) {
  if (reloadAlways_->isChecked()) return reload(files);
  changed_ << files;
  changed_.removeDuplicates();
  offerReload();
}

void PartFiles::tellOfOthers(const QStringList& files) {
  if (!session_.isModified()) return;
  sceneOfOthers_ = session_.sceneSerial();
  const QString text = files.size() == 1 ? tr("%1 has changed since this scene was saved. The new version is "
                                              "shown; save the scene to accept it.")
                                         : tr("%1 have changed since this scene was saved. The new versions "
                                              "are shown; save the scene to accept them.");
  notices_.offer(kOthersNotice, text.arg(namesOf(files)), {{tr("OK"), [] {}}});
}

void PartFiles::offerReload() {
  // Files that have left the scene meanwhile are not worth asking about.
  QSet<QString> ofScene;
  for (const PartGeometryPtr& geometry : session_.scene().geometries())
    ofScene << fromPath(geometry->file);
  QStringList there;
  for (const QString& file : changed_) {
    if (ofScene.contains(file)) there << file;
  }
  changed_ = there;
  if (changed_.isEmpty()) return notices_.withdraw(kReloadNotice);
  const QString text = changed_.size() == 1 ? tr("%1 has changed on disk since it was read.")
                                            : tr("%1 have changed on disk since they were read.");
  const auto always = [this] {
    reloadAlways_->setChecked(true);
    reload(changed_);
  };
  notices_.offer(kReloadNotice, text.arg(namesOf(changed_)),
                 {{tr("Reload"), [this] { reload(changed_); }}, {tr("Reload always"), always}},
                 [this] { changed_.clear(); });
}

std::vector<PartFiles::Wanted> PartFiles::partsOf(const QStringList& files) const {
  const QSet<QString> chosen(files.begin(), files.end());
  std::vector<Wanted> wanted;
  for (const Scene::PartPtr& part : session_.scene().parts()) {
    if (part->geometry == nullptr) continue;
    if (files.isEmpty() || chosen.contains(fromPath(part->geometry->file)))
      wanted.push_back({part->id,
                        part->geometry->metresPerUnit,
                        {},
                        part->geometry->tessellation,
                        part->geometry->repairs});
  }
  return wanted;
}

// By value: `files` may be changed_ itself. NOLINTNEXTLINE(performance-unnecessary-value-param)
void PartFiles::reload(QStringList files) {
  if (document_.isBusy()) {
    waiting_ << files;
    return;
  }
  const QSet<QString> chosen(files.begin(), files.end());
  const auto isReloaded = [&](const QString& file) { return files.isEmpty() || chosen.contains(file); };
  changed_.erase(std::remove_if(changed_.begin(), changed_.end(), isReloaded), changed_.end());
  offerReload();
  load(
      {tr("Reloading"), tr("Reloading %1").arg(files.isEmpty() ? tr("all parts") : namesOf(files))},
      partsOf(files),
      [this](const std::vector<Session::NewGeometry>& renewed) { session_.reloadParts(renewed); },
      tr("Some parts could not be reloaded; they stay as they were."));
}

PartFiles::ProgressText PartFiles::textAbout(const std::vector<Wanted>& parts, const QString& title,
                                             const QString& text) const {
  constexpr int kNamed = 3;
  QStringList names;
  for (const Wanted& each : parts)
    names << QString::fromStdString(session_.scene().get(each.part).name);
  return {title, text.arg(listOfNames(names, kNamed))};
}

void PartFiles::load(const ProgressText& text, const std::vector<Wanted>& wanted, const Command& command,
                     const QString& failure, const Result& result) {
  std::vector<MeshSource> sources;
  std::vector<std::size_t> sourceOf;
  using Key =
      std::tuple<std::filesystem::path, double, std::string, std::string, double, double, std::string>;
  std::map<Key, std::size_t> known;
  for (const Wanted& want : wanted) {
    const PartGeometry& geometry = *session_.scene().find(want.part)->geometry;
    const auto [source, isNew] =
        known.try_emplace(Key(geometry.file, want.metresPerUnit, want.sha256, geometry.shapeKey,
                              want.tessellation.chord, want.tessellation.angle, textOf(want.repairs)),
                          sources.size());
    sourceOf.push_back(source->second);
    if (isNew) {
      sources.push_back({geometry.file, want.metresPerUnit, want.sha256, geometry.shapeKey, want.tessellation,
                         want.repairs});
    }
  }
  if (sources.empty()) return;
  auto loaded = std::make_shared<std::vector<LoadedPart>>();
  const auto job = [loaded, sources, shapes = document_.shapes()](const ProgressCallback& progress) {
    *loaded = loadPartGeometries(sources, progressOfReading(progress));
    std::vector<PartGeometryPtr> geometries;
    for (const LoadedPart& part : *loaded) {
      if (part.geometry) geometries.push_back(part.geometry);
    }
    shapes->prepare(geometries, progressOfShapes(progress));
  };
  document_.load(text.title, text.text, job, [=, this](const std::exception_ptr& error) {
    if (isCancelled(error)) return emit noted(tr("Cancelled. No part was changed."));
    QVector<FailedItem> problems;
    if (error) problems << describeItem({}, error);
    for (std::size_t i = 0; i < loaded->size(); ++i) {
      if (const std::exception_ptr problem = problemOf((*loaded)[i], sources[i].file))
        problems << describeItem(fromPath(sources[i].file.filename()), problem);
    }
    std::vector<Session::NewGeometry> renewed;
    for (std::size_t i = 0; !error && i < wanted.size(); ++i) {
      const PartGeometryPtr& geometry = (*loaded)[sourceOf[i]].geometry;
      const Part* part = session_.scene().find(wanted[i].part);
      if (part == nullptr || !geometry) continue;
      // The second name tells of companions too.
      const bool isSame = part->geometry->sha256 == geometry->sha256 &&
                          part->geometry->cacheName == geometry->cacheName &&
                          part->geometry->metresPerUnit == geometry->metresPerUnit &&
                          part->geometry->tessellation == geometry->tessellation &&
                          part->geometry->repairs == geometry->repairs;
      if (!isSame) renewed.push_back({part->id, geometry});
    }
    try {
      command(renewed);
    } catch (...) {
      problems << describeItem({}, std::current_exception());
    }
    if (!problems.isEmpty())
      emit failed(describeItems(failure, problems));
    else if (result)
      emit noted(result(renewed));
    else
      emit noted(renewed.empty() ? tr("No file has changed")
                                 : tr("Done: %1. Undo to revert.").arg(shortName(session_.undoText())));
  });
}

void PartFiles::followGeometries() {
  std::map<PartId, PartGeometryPtr> now;
  for (const Scene::PartPtr& part : session_.scene().parts())
    now.emplace(part->id, part->geometry);
  const bool isSameScene = std::exchange(sceneFollowed_, session_.sceneSerial()) == session_.sceneSerial();
  if (!isSameScene) doubted_.clear();
  if (now == geometries_) return;
  const std::map<PartId, PartGeometryPtr> before = std::exchange(geometries_, std::move(now));
  // Its ratio and factor were those of the sizes before.
  if (!offerRescaleOf(doubted_)) notices_.withdraw(kRescaleNotice);
  // Undo and redo change units too.
  if (isSameScene && haveOtherUnits(before, geometries_)) emit rescaled();
}

void PartFiles::judgeSizes(const std::vector<PartId>& added) {
  if (offerRescaleOf(added)) doubted_ = added;
}

bool PartFiles::offerRescaleOf(std::vector<PartId> parts) {
  const Scene& scene = session_.scene();
  // A unit that the file stores is right, except where formats fix one that programs ignore.
  std::erase_if(parts, [&](PartId id) {
    const Part* part = scene.find(id);
    return part == nullptr || part->geometry == nullptr || !canChangeUnit(*part->geometry);
  });
  if (parts.empty()) return false;
  if (const std::optional<OddSize> odd = oddSizeOf(scene, parts)) {
    offerRescale(parts, odd->ratio, odd->factor);
    return true;
  }
  // Within a document, sizes are right relative to each other: it is doubted as a whole only.
  std::vector<PartId> ofDocuments;
  std::erase_if(parts, [&](PartId id) {
    const bool isOfDocument = mayBeInWrongUnit(scene.get(id).geometry->file);
    if (isOfDocument) ofDocuments.push_back(id);
    return isOfDocument;
  });
  if (const std::optional<OddPart> odd = firstOddPart(scene, parts)) {
    offerRescale({odd->part}, odd->size.ratio, odd->size.factor);
    return true;
  }
  if (const std::optional<OddSize> odd = oddSizeOf(scene, ofDocuments)) {
    offerRescale(ofDocuments, odd->ratio, odd->factor);
    return true;
  }
  return offerRescaleOfHuge(ofDocuments);
}

bool PartFiles::offerRescaleOfHuge(const std::vector<PartId>& parts) {
  if (parts.empty()) return false;
  const Scene& scene = session_.scene();
  const std::filesystem::path& file = scene.get(parts.front()).geometry->file;
  Aabb box;
  for (const PartId id : parts) {
    const Part& part = scene.get(id);
    const Aabb& own = part.geometry->mesh.bounds();
    // A unit other than the format's has been chosen by the user, or is stated.
    if (part.geometry->file != file || own.isEmpty() || part.geometry->metresPerUnit != 1.0 ||
        part.geometry->statedUnit != 1.0)
      continue;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p((corner & 1) != 0 ? own.upper.x : own.lower.x,
                         (corner & 2) != 0 ? own.upper.y : own.lower.y,
                         (corner & 4) != 0 ? own.upper.z : own.lower.z);
      box.add(part.worldFromPart.applyToPoint(p));
    }
  }
  if (box.isEmpty() || box.diagonal() < kHugeDocument) return false;
  constexpr double kMillimetre = 1e-3;
  notices_.offer(
      kRescaleNotice,
      tr("“%1” is %2 m large. Is the unit right?").arg(fromPath(file.filename()), about(box.diagonal())),
      {{tr("Make %1 times smaller").arg(times(1.0 / kMillimetre)),
        [this, parts] { rescale(parts, kMillimetre); }}},
      [this] { doubted_.clear(); });
  return true;
}

void PartFiles::offerRescale(const std::vector<PartId>& parts, double ratio, double factor) {
  const Part* first = session_.scene().find(parts.front());
  const QString what = parts.size() == 1
                           ? tr("“%1” is").arg(QString::fromStdString(first->name))
                           : tr("The %n new parts are", nullptr, static_cast<int>(parts.size()));
  const QString text = ratio > 1.0 ? tr("%1 %2 times larger than the other parts. Is the unit right?")
                                   : tr("%1 %2 times smaller than the other parts. Is the unit right?");
  const QString offer = factor > 1.0 ? tr("Make %1 times larger").arg(times(factor))
                                     : tr("Make %1 times smaller").arg(times(1.0 / factor));
  notices_.offer(kRescaleNotice, text.arg(what, about(ratio > 1.0 ? ratio : 1.0 / ratio)),
                 {{offer, [this, parts, factor] { rescale(parts, factor); }}}, [this] { doubted_.clear(); });
}

void PartFiles::rescale(const std::vector<PartId>& parts, double factor) {
  std::vector<Wanted> wanted;
  for (const PartId id : withWholeDocuments(parts)) {
    const Part* part = session_.scene().find(id);
    if (part != nullptr) wanted.push_back(inUnit(*part, part->geometry->metresPerUnit * factor));
  }
  loadInUnits(textAbout(wanted, tr("Rescaling"), tr("Rescaling %1")), wanted,
              tr("The parts could not be rescaled."));
}

std::vector<PartId> PartFiles::withWholeDocuments(const std::vector<PartId>& parts) const {
  const Scene& scene = session_.scene();
  std::set<std::filesystem::path> documents;
  for (const PartId id : parts) {
    const Part* part = scene.find(id);
    if (part != nullptr && part->geometry != nullptr && mayBeInWrongUnit(part->geometry->file))
      documents.insert(part->geometry->file);
  }
  std::vector<PartId> all = parts;
  for (const Scene::PartPtr& part : scene.parts()) {
    if (part->geometry != nullptr && documents.contains(part->geometry->file) &&
        std::ranges::find(parts, part->id) == parts.end())
      all.push_back(part->id);
  }
  return all;
}

PartFiles::Wanted PartFiles::inUnit(const Part& part, double metresPerUnit) {
  // Tolerances grow with the mesh, so that they do the same to it.
  const double factor = metresPerUnit / part.geometry->metresPerUnit;
  return {part.id, metresPerUnit, part.geometry->sha256,
          scaledTessellation(part.geometry->tessellation, factor),
          scaledRepairs(part.geometry->repairs, factor)};
}

void PartFiles::repair(const std::vector<PartId>& parts, const MeshRepairs& repairs) {
  if (document_.isBusy()) return;
  if (hand_.status().isTaken()) return emit noted(tr("Stop (F6) before you repair a part"));
  auto repaired = std::make_shared<Repaired>();
  QStringList names;
  for (const PartId id : parts) {
    const Part* part = session_.scene().find(id);
    if (part == nullptr || part->geometry == nullptr) continue;
    names << QString::fromStdString(part->name);
    if (std::ranges::count(*repaired, part->geometry, &Repaired::value_type::first) == 0)
      repaired->emplace_back(part->geometry, GeometryRepair());
  }
  if (repaired->empty()) return;
  const auto job = [repaired, repairs, shapes = document_.shapes()](const ProgressCallback& progress) {
    std::vector<PartGeometryPtr> made;
    for (std::size_t i = 0; i < repaired->size(); ++i) {
      const auto count = static_cast<double>(repaired->size());
      const ProgressCallback reading = progressOfReading(progress);
      const ProgressCallback own =
          stageCallback(reading, static_cast<double>(i) / count, static_cast<double>(i + 1) / count);
      (*repaired)[i].second = repairGeometry(*(*repaired)[i].first, repairs, own);
      if ((*repaired)[i].second.geometry) made.push_back((*repaired)[i].second.geometry);
    }
    shapes->prepare(made, progressOfShapes(progress));
  };
  constexpr int kNamed = 3;
  document_.load(tr("Repairing"), tr("Repairing %1").arg(listOfNames(names, kNamed)), job,
                 [=, this](const std::exception_ptr& error) {
                   if (isCancelled(error)) return emit noted(tr("Cancelled. No part was changed."));
                   try {
                     if (error) std::rethrow_exception(error);
                     takeRepaired(parts, *repaired);
                   } catch (...) {
                     emit failed(describe(tr("The part could not be repaired."), std::current_exception()));
                   }
                 });
}

void PartFiles::takeRepaired(const std::vector<PartId>& parts, const Repaired& repaired) {
  // Feeling may have begun since.
  if (hand_.status().isTaken())
    throw UsageError("", "a part is being felt", "stop feeling it (F6), then try again");
  std::vector<Session::NewGeometry> renewed;
  for (const PartId id : parts) {
    const Part* part = session_.scene().find(id);
    if (part == nullptr) continue;
    const auto own = std::ranges::find(repaired, part->geometry, &Repaired::value_type::first);
    if (own != repaired.end() && own->second.geometry) renewed.push_back({id, own->second.geometry});
  }
  session_.repairParts(renewed);
  emit this->repaired(repaired.front().second);
  emit noted(renewed.empty() ? tr("There was nothing to repair") : tr("Repaired; undo to revert"));
}

void PartFiles::changeUnit(const std::vector<PartId>& parts) {
  if (document_.isBusy()) return;
  if (hand_.status().isTaken()) return emit noted(tr("Stop (F6) before you change the unit"));
  QStringList names;
  std::optional<double> present;
  for (const PartId id : parts) {
    const Part* part = session_.scene().find(id);
    if (part == nullptr || part->geometry == nullptr) continue;
    if (!canChangeUnit(*part->geometry)) {
      const QString file = fromPath(part->geometry->file.filename());
      return emit failed(
          {tr("The unit of “%1” cannot be changed.").arg(QString::fromStdString(part->name)),
           tr("%1 stores its unit, and its sizes are right in that. To scale it, export it from the "
              "CAD system in another size.")
               .arg(file)});
    }
    if (part->geometry->mesh.bounds().isEmpty()) continue;
    names << QString::fromStdString(part->name);
    if (!present) present = part->geometry->unitOfNumbers();
  }
  if (!present) return;
  const std::vector<PartId> all = withWholeDocuments(parts);
  const std::optional<double> unit =
      askForOtherUnit(names, extentInUnits(session_.scene(), all),
                      UnitHints{.scene = extentOfOthers(session_.scene(), all)}, *present, window_);
  if (!unit) return;
  std::vector<Wanted> wanted;
  for (const PartId id : all) {
    const Part* part = session_.scene().find(id);
    if (part == nullptr || part->geometry == nullptr) continue;
    const double metresPerUnit = *unit / part->geometry->statedUnit;
    if (metresPerUnit != part->geometry->metresPerUnit) wanted.push_back(inUnit(*part, metresPerUnit));
  }
  loadInUnits(textAbout(wanted, tr("Changing the unit"), tr("Changing the unit of %1")), wanted,
              tr("The unit of some parts could not be changed."));
}

void PartFiles::refine(const std::vector<PartId>& parts) {
  if (document_.isBusy()) return;
  if (hand_.status().isTaken()) return emit noted(tr("Stop (F6) before you refine parts"));
  const QString failure = tr("The parts could not be refined.");
  try {
    // Refuses, before it asks, what cannot be refined.
    const Refinement present = refinementOf(session_.scene(), parts, {});
    if (present.members.empty()) return;
    const std::optional<Tessellation> wanted = askForTessellation(session_.scene(), present, window_);
    if (!wanted) return;
    std::vector<Wanted> all;
    for (const Refinement::Member& member : present.members) {
      const PartGeometry& geometry = *session_.scene().get(member.part).geometry;
      all.push_back({member.part, geometry.metresPerUnit, geometry.sha256, *wanted, geometry.repairs});
    }
    const auto before = std::make_shared<std::size_t>(0);
    const auto apply = [this, before](const std::vector<Session::NewGeometry>& renewed) {
      if (renewed.empty()) return;
      // Feeling may have begun since.
      if (hand_.status().isTaken())
        throw UsageError("", "a part is being felt", "stop feeling it (F6), then try again");
      std::vector<PartGeometryPtr> old;
      for (const Session::NewGeometry& part : renewed)
        old.push_back(session_.scene().get(part.part).geometry);
      *before = trianglesOf(old);
      session_.refineParts(renewed);
    };
    const auto result = [this, before](const std::vector<Session::NewGeometry>& renewed) {
      if (renewed.empty()) return tr("Nothing to refine: the values are as before");
      std::vector<PartGeometryPtr> now;
      for (const Session::NewGeometry& part : renewed)
        now.push_back(part.geometry);
      const auto number = [](std::size_t count) {
        return QLocale().toString(static_cast<qulonglong>(count));
      };
      return tr("Done: %1, %2 triangles instead of %3. Undo to revert.")
          .arg(shortName(session_.undoText()), number(trianglesOf(now)), number(*before));
    };
    load(textAbout(all, tr("Refining"), tr("Refining %1")), all, apply, failure, result);
  } catch (const UsageError&) {
    emit failed(describe(failure, std::current_exception()));
  }
}

void PartFiles::loadInUnits(const ProgressText& text, const std::vector<Wanted>& wanted,
                            const QString& failure) {
  if (document_.isBusy()) return emit noted(tr("Files are still loading. Try again when they are done."));
  const auto apply = [this](const std::vector<Session::NewGeometry>& renewed) {
    if (renewed.empty()) return;
    // Feeling may have begun since.
    if (hand_.status().isTaken())
      throw UsageError("", "a part is being felt", "stop feeling it (F6), then try again");
    session_.rescaleParts(renewed);
  };
  load(text, wanted, apply, failure);
}

}  // namespace nearfit::ui
