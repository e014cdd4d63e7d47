#include "ui/files/dropped_files.h"

#include <QDirIterator>
#include <QFileInfo>
#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "core/import/companion_files.h"
#include "core/import/document_import.h"
#include "core/import/mesh_import.h"
#include "ui/widgets/paths.h"

namespace nearfit::ui {
namespace {

bool isScene(const QString& file) {
  return QFileInfo(file).suffix().toLower() == QLatin1String("nearfit");
}

const QString kPacked = QStringLiteral(".gz");

bool isMesh(const QString& file) {
  const std::filesystem::path path = toPath(file);
  if (isDocumentFile(path)) return true;
  const std::vector<std::string>& known = importableExtensions();
  const QString lowered = file.toLower();
  const QString plain = lowered.endsWith(kPacked) ? lowered.chopped(kPacked.size()) : lowered;
  return std::ranges::find(known, QFileInfo(plain).suffix().toStdString()) != known.end();
}

QStringList patternsOf(const std::vector<std::string>& extensions) {
  QStringList patterns;
  for (const std::string& extension : extensions) {
    const QString suffix = QString::fromStdString(extension);
    patterns << QStringLiteral("*.") + suffix << QStringLiteral("*.") + suffix.toUpper();
    // Binary formats are refused so.
    if (isMesh(QStringLiteral("a.") + suffix + kPacked)) patterns << QStringLiteral("*.") + suffix + kPacked;
  }
  return patterns;
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

/// The file without links on its way; empty if it is not there.
std::filesystem::path realFile(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::canonical(file, error);
}

/// The files without the meshes that a URDF file among them brings: they came twice, and were asked the unit of.
/// @param kept  Stay: the user has named them.
QStringList withoutMeshesOfRobots(const QStringList& files, const QStringList& kept) {
  std::set<std::filesystem::path> brought;
  for (const QString& file : files)
    for (const std::filesystem::path& mesh : meshFilesNamedIn(toPath(file)))
      brought.insert(realFile(mesh));
  // One that vanished meanwhile.
  brought.erase(std::filesystem::path());
  if (brought.empty()) return files;
  QStringList left;
  for (const QString& file : files)
    if (kept.contains(file) || !brought.contains(realFile(toPath(file)))) left << file;
  return left;
}

}  // namespace

QStringList meshPatterns() {
  return patternsOf(importableExtensions());
}

QStringList documentPatterns() {
  return patternsOf(documentExtensions());
}

DroppedFiles sortOut(const QStringList& filesAndFolders) {
  DroppedFiles dropped;
  for (const QString& file : filesAndFolders) {
    if (QFileInfo(file).isDir())
      addFolder(file, dropped);
    else
      (isScene(file) ? dropped.scenes : dropped.meshes) << file;
  }
  dropped.meshes = withoutMeshesOfRobots(dropped.meshes, filesAndFolders);
  return dropped;
}

}  // namespace nearfit::ui
