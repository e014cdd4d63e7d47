#include "ui/files/dropped_files.h"

#include <QDirIterator>
#include <QFileInfo>
#include <algorithm>

#include "core/import/mesh_import.h"

namespace nearfit::ui {
namespace {

bool isScene(const QString& file) {
  return QFileInfo(file).suffix().toLower() == QLatin1String("nearfit");
}

bool isMesh(const QString& file) {
  const std::vector<std::string>& known = importableExtensions();
  return std::ranges::find(known, QFileInfo(file).suffix().toLower().toStdString()) != known.end();
}

void addFolder(const QString& folder, DroppedFiles& dropped) {
  QStringList scenes, meshes;
  QDirIterator it(folder, QDir::Files | QDir::NoDotAndDotDot, QDirIterator::Subdirectories);
  while (it.hasNext() && !dropped.isCutOff) {
    const QString file = it.next();
    if (isScene(file)) scenes << file;
    if (isMesh(file)) meshes << file;
    dropped.isCutOff = dropped.meshes.size() + meshes.size() >= kMaxInFolders;
  }
  scenes.sort();
  meshes.sort();
  dropped.meshes << meshes;
  if (meshes.isEmpty()) dropped.scenes << scenes;
  if (meshes.isEmpty() && scenes.isEmpty()) dropped.emptyFolders << folder;
}

}  // namespace

DroppedFiles sortOut(const QStringList& filesAndFolders) {
  DroppedFiles dropped;
  for (const QString& file : filesAndFolders) {
    if (QFileInfo(file).isDir())
      addFolder(file, dropped);
    else
      (isScene(file) ? dropped.scenes : dropped.meshes) << file;
  }
  return dropped;
}

}  // namespace nearfit::ui
