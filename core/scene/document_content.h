#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/import/cad_document.h"
#include "core/scene/part_geometry.h"

namespace nearfit {

/// Hashes of all that a document shows: the bytes of its file and of its companions.
struct DocumentContent {
  std::string sha256;                                ///< Of the file itself.
  std::shared_ptr<const CompanionFiles> companions;  ///< Null if there are none.
  /// Names all of it in the cache: the file's SHA-256, or one of all SHA-256s. Empty if something else decides too.
  std::string name;
};

/// Content of a document on disk, which the cache knows the companions of; no value if it does not, or if one of them is
/// missing, is not a regular file, or lies where the importer would not look for it.
/// @param sha256      Of the file.
/// @param onProgress  Gets the fraction of the companions hashed, and may throw to stop.
std::optional<DocumentContent> contentOnDisk(const std::filesystem::path& file, const std::string& sha256,
                                             const std::function<void(double fraction)>& onProgress);

/// Content that a document had when it was imported. Companions that lie where the importer would not look for them, or
/// are too many, make it one without a name.
DocumentContent contentOf(const std::filesystem::path& file, const CadDocument& imported);

/// Keeps the names of an imported document's companions in the cache for contentOnDisk().
void storeCompanionNames(const std::filesystem::path& file, const DocumentContent& content,
                         const CadDocument& imported);

}  // namespace nearfit
