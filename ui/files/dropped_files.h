#pragma once

#include <QStringList>

namespace nearfit::ui {

/// Files and folders that a user gave, sorted out.
struct DroppedFiles {
  QStringList scenes, meshes;
  QStringList emptyFolders;  ///< In which there is nothing that can be opened.
  bool isCutOff = false;     ///< There were more than kMostInFolders.
};

/// How many files are taken out of folders: beyond it somebody has dropped a disk.
constexpr int kMostInFolders = 2000;

/// Takes folders apart, in the order of names; links to folders are not followed. In folders only files of
/// formats that can be read count, and scenes only where there is no mesh.
DroppedFiles sortOut(const QStringList& filesAndFolders);

}  // namespace nearfit::ui
