#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "core/scene/scene.h"

/// A recovery journal is a scene file (scene_file.h) with absolute mesh paths and one more key:
///
///     "recovery": {
///       "scene": "/home/me/pump.nearfit",   the scene's file, or null if it was never saved
///       "changes": 12,                      number of steps since the last save
///       "sha256": "9f86d0..."               of this file's text without this key
///     }
namespace nearfit {

/// Summary of a journal.
struct JournalHead {
  std::filesystem::path scene;  ///< The scene's file; empty if it was never saved.
  /// Steps since the last save; number of parts.
  std::size_t changes = 0, parts = 0;
};

/// The text of a journal. `head.parts` is ignored. Throws FileError if a path is not UTF-8.
std::string journalText(const Scene& scene, const JournalHead& head);

/// Checks that a journal is intact and returns its summary. The scene itself is read by readSceneFile().
/// Throws FileError if the journal is damaged or cannot be read.
JournalHead readJournalHead(const std::filesystem::path& journal);

/// True if the scene's file holds the journal's scene, so that nothing is lost.
bool isSaved(const std::filesystem::path& journal, const JournalHead& head);

}  // namespace nearfit
