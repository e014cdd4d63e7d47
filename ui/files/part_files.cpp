#include "ui/files/part_files.h"

#include <QAction>
#include <QFileInfo>
#include <QLocale>
#include <QMenu>
#include <QSet>
#include <QSettings>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "core/base/error.h"
#include "core/scene/odd_size.h"
#include "ui/files/document.h"
#include "ui/files/mesh_watch.h"
#include "ui/widgets/names.h"
#include "ui/widgets/notice_bar.h"
#include "ui/widgets/paths.h"
#include "ui/widgets/theme.h"

namespace nearfit::ui {
namespace {

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

/// Returns "1000" or "25.4".
QString times(double factor) {
  return QLocale().toString(factor, 'g', factor >= 100.0 ? 4 : 3);
}

}  // namespace

PartFiles::PartFiles(Session& session, Document& document, NoticeBar& notices, QMenu* menu, QObject* parent)
    : QObject(parent),
      session_(session),
      document_(document),
      notices_(notices),
      watch_(new MeshWatch(session, this)) {
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
  reload_->setToolTip(tr("Read the mesh files of all parts again; poses stay"));
  reload_->setShortcut(QKeySequence(QStringLiteral("Ctrl+R")));
  connect(reload_, &QAction::triggered, this, [this] { reload({}); });
  reloadAlways_ = menu->addAction(tr("Reload changed parts &without asking"));
  reloadAlways_->setObjectName(QStringLiteral("reloadAlways"));
  reloadAlways_->setToolTip(tr("Reload a mesh as soon as its file changes on disk"));
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
      wanted.push_back({part->id, part->geometry->metresPerUnit});
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
  load(tr("Reloading %1").arg(files.isEmpty() ? tr("all parts") : namesOf(files)), partsOf(files),
       &Session::reloadParts, tr("Some parts could not be reloaded; they stay as they were."));
}

void PartFiles::load(const QString& text, const std::vector<Wanted>& wanted, Command command,
                     const QString& failure) {
  std::vector<MeshSource> sources;
  std::vector<std::size_t> sourceOf;
  std::map<std::pair<std::filesystem::path, double>, std::size_t> known;
  for (const Wanted& want : wanted) {
    const PartGeometry& geometry = *session_.scene().find(want.part)->geometry;
    const auto [source, isNew] =
        known.try_emplace(std::pair(geometry.file, want.metresPerUnit), sources.size());
    sourceOf.push_back(source->second);
    if (isNew) sources.push_back({geometry.file, want.metresPerUnit, {}});
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
  document_.load(text, job, [=, this](const std::exception_ptr& error) {
    if (isCancelled(error)) return;
    QVector<FailedItem> problems;
    if (error) problems << describeItem({}, error);
    for (std::size_t i = 0; i < loaded->size(); ++i) {
      const QString name = fromPath(sources[i].file.filename());
      if ((*loaded)[i].problem) problems << describeItem(name, (*loaded)[i].problem);
    }
    std::vector<Session::NewGeometry> renewed;
    for (std::size_t i = 0; !error && i < wanted.size(); ++i) {
      const PartGeometryPtr& geometry = (*loaded)[sourceOf[i]].geometry;
      const Part* part = session_.scene().find(wanted[i].part);
      if (part == nullptr || !geometry) continue;
      const bool isSame = part->geometry->sha256 == geometry->sha256 &&
                          part->geometry->metresPerUnit == geometry->metresPerUnit;
      if (!isSame) renewed.push_back({part->id, geometry});
    }
    try {
      // If called with .*, GCC 12's sanitizer reads a `this` that it has not set.
      std::invoke(command, session_, renewed);
    } catch (...) {
      problems << describeItem({}, std::current_exception());
    }
    if (!problems.isEmpty())
      emit failed(describeItems(failure, problems));
    else
      emit noted(renewed.empty() ? tr("No file has changed") : tr("Undo reverts this change"));
  });
}

void PartFiles::judgeSizes(const std::vector<PartId>& added) {
  if (const std::optional<OddSize> odd = oddSizeOf(session_.scene(), added)) {
    offerRescale(added, odd->ratio, odd->factor);
    return;
  }
  if (const std::optional<OddPart> odd = firstOddPart(session_.scene(), added))
    offerRescale({odd->part}, odd->size.ratio, odd->size.factor);
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
  notices_.offer(kRescaleNotice, text.arg(what, times(ratio > 1.0 ? ratio : 1.0 / ratio)),
                 {{offer, [this, parts, factor] { rescale(parts, factor); }}});
}

void PartFiles::rescale(const std::vector<PartId>& parts, double factor) {
  if (document_.isBusy()) return;
  std::vector<Wanted> wanted;
  for (const PartId id : parts) {
    const Part* part = session_.scene().find(id);
    if (part != nullptr) wanted.push_back({id, part->geometry->metresPerUnit * factor});
  }
  load(tr("Rescaling"), wanted, &Session::rescaleParts, tr("The parts could not be rescaled."));
}

}  // namespace nearfit::ui
