#include "ui/files/mesh_watch.h"

#include <QDateTime>
#include <QFileInfo>
#include <algorithm>
#include <memory>
#include <set>

#include "core/base/error.h"
#include "core/files/sha256.h"
#include "ui/widgets/paths.h"

namespace nearfit::ui {

MeshWatch::MeshWatch(Session& session, QObject* parent) : QObject(parent), session_(session) {
  timer_.setSingleShot(true);
  timer_.setInterval(kSettle);
  connect(&timer_, &QTimer::timeout, this, &MeshWatch::settle);
  connect(&watcher_, &QFileSystemWatcher::fileChanged, this,
          [this](const QString& file) { look(QFileInfo(file).absolutePath()); });
  connect(&watcher_, &QFileSystemWatcher::directoryChanged, this, &MeshWatch::look);
  changes_ = session_.onChange(SceneEvents::Stage::Panels, [this] { watchScene(); });
}

MeshWatch::Stamp MeshWatch::stampOf(const QString& file) {
  const QFileInfo info(file);
  return info.exists() ? Stamp{info.lastModified().toMSecsSinceEpoch(), info.size()} : Stamp{};
}

QSet<QString> MeshWatch::filesOfScene() const {
  QSet<QString> files;
  // Shapes of a document share them.
  std::set<const CompanionFiles*> taken;
  for (const PartGeometryPtr& geometry : session_.scene().geometries()) {
    if (!geometry->file.empty()) files << fromPath(geometry->file);
    if (geometry->companions == nullptr || !taken.insert(geometry->companions.get()).second) continue;
    for (const CompanionFile& companion : *geometry->companions)
      files << fromPath(companion.file);
  }
  return files;
}

void MeshWatch::watchScene() {
  const QSet<QString> files = filesOfScene();
  const QStringList before = known_.keys();
  for (const QString& file : before) {
    if (files.contains(file)) continue;
    watcher_.removePath(file);
    known_.remove(file);
    pending_.remove(file);
  }
  QSet<QString> folders;
  for (const QString& file : files) {
    folders << QFileInfo(file).absolutePath();
    if (known_.contains(file)) continue;
    known_[file] = stampOf(file);
    if (QFileInfo::exists(file)) watcher_.addPath(file);
  }
  const QStringList watched = watcher_.directories();
  for (const QString& folder : watched) {
    if (!folders.remove(folder)) watcher_.removePath(folder);
  }
  for (const QString& folder : folders)
    watcher_.addPath(folder);
}

void MeshWatch::look(const QString& folder) {
  const QStringList files = watcher_.files();
  const QSet<QString> watched(files.begin(), files.end());
  for (auto it = known_.cbegin(); it != known_.cend(); ++it) {
    const QString& file = it.key();
    if (QFileInfo(file).absolutePath() != folder) continue;
    const Stamp now = stampOf(file);
    // Replacing a file ends its watch.
    if (now != Stamp{} && !watched.contains(file)) watcher_.addPath(file);
    if (now == it.value() || now == Stamp{}) continue;
    pending_[file] = now;
    timer_.start();
  }
}

void MeshWatch::settle() {
  if (task_.isRunning()) {
    timer_.start();
    return;
  }
  QStringList quiet;
  const QStringList files = pending_.keys();
  for (const QString& file : files) {
    const Stamp now = stampOf(file);
    if (now == pending_[file]) {
      known_[file] = now;
      pending_.remove(file);
      quiet << file;
    } else if (now == Stamp{}) {
      pending_.remove(file);  // Gone again; its folder tells when it returns.
    } else {
      pending_[file] = now;
    }
  }
  if (!pending_.isEmpty()) timer_.start();
  if (!quiet.isEmpty()) compare(quiet);
}

void MeshWatch::compare(const QStringList& files) {
  auto hashes = std::make_shared<QMap<QString, std::string>>();
  const auto job = [hashes, files](const ProgressCallback& progress) {
    for (const QString& file : files) {
      try {
        (*hashes)[file] = sha256OfFile(toPath(file), [&](double) {
          if (!progress(0.0)) throw Cancelled();
        });
      } catch (const FileError&) {
        // It cannot be read now; its next change brings another look.
      }
    }
  };
  task_.run(job, [this, hashes](const std::exception_ptr&) {
    const auto differs = [&hashes](const QString& file, const std::string& sha256) {
      return hashes->contains(file) && hashes->value(file) != sha256;
    };
    QStringList different;
    std::set<const CompanionFiles*> same;
    for (const PartGeometryPtr& geometry : session_.scene().geometries()) {
      const QString file = fromPath(geometry->file);
      if (different.contains(file)) continue;
      const CompanionFiles* companions = geometry->companions.get();
      const bool isOwn = differs(file, geometry->sha256);
      // Shapes of a document share them.
      const bool isCompanion = !isOwn && companions != nullptr && !same.contains(companions) &&
                               std::ranges::any_of(*companions, [&](const CompanionFile& companion) {
                                 return differs(fromPath(companion.file), companion.sha256);
                               });
      if (isOwn || isCompanion)
        different << file;
      else
        same.insert(companions);
    }
    if (!different.isEmpty()) emit changed(different);
  });
}

}  // namespace nearfit::ui
