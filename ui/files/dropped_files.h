#pragma once

#include <QStringList>

namespace nearfit::ui {

/// Files and folders from the user, sorted.
struct DroppedFiles {
  QStringList scenes;
  QStringList meshes;        ///< Mesh files and CAD documents.
  QStringList emptyFolders;  ///< They hold nothing that can be opened.
  bool isCutOff = false;     ///< There were more files than kMaxInFolders.
};

/// File name patterns of mesh files and of CAD documents: "*.stl", and "*.stl.gz" where such are read, and so on.
QStringList meshPatterns();
QStringList documentPatterns();

/// Limit of files taken from folders: with more, somebody has dropped a disk.
constexpr int kMaxInFolders = 2000;

/// Sorts files and searches folders, in order of name; does not follow links to folders. In folders only
/// readable formats count, and scenes only if there is no mesh. Leaves out what lies in folders and is a mesh that a URDF
/// file among all of these names: it comes with that file.
DroppedFiles sortOut(const QStringList& filesAndFolders);

}  // namespace nearfit::ui
