#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/scene/scene.h"

/// A recovery journal: a scene file (scene_file.h) with absolute paths to its meshes and one key more:
///
///     "recovery": {
///       "scene": "/home/me/pump.nearfit",   the file that the scene is saved in, or null
///       "changes": 12,                      since then
///       "sha256": "9f86d0..."               of the text of this file without this key
///     }
namespace nearfit {

struct JournalHead {
  std::filesystem::path scene;  ///< Empty when it was never saved.
  std::size_t changes = 0, parts = 0;
};

/// The text of a journal. Throws FileError when a path cannot be written as JSON.
std::string journalText(const Scene& scene, const JournalHead& head);

/// What a journal is of, once it is checked to be whole; its parts are counted. The scene itself is read by
/// readSceneFile. Throws FileError when it is damaged or cannot be read.
JournalHead readJournalHead(const std::filesystem::path& journal);

/// Whether the journal's scene is the one that its file holds: nothing of it was lost.
bool isSaved(const std::filesystem::path& journal, const JournalHead& head);

}  // namespace nearfit
