#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/group.h"
#include "core/scene/part.h"
#include "core/text/json_file.h"

/// Reads and checks parts and groups of a scene file (format: scene_file.h) without loading meshes; used by
/// the scene file reader. Each function throws FileError naming the field that is missing or invalid.
namespace nearfit {

/// A part as in the file, its mesh not loaded yet.
struct PartEntry {
  JsonField field;
  Part part;                         ///< `group` and `geometry` are not set.
  std::optional<std::size_t> group;  ///< Index into the groups.
  std::filesystem::path mesh;
  std::string sha256;
  double metresPerUnit;
};

/// A group as in the file.
struct GroupEntry {
  Group group;                        ///< `parent` is not set.
  std::optional<std::size_t> parent;  ///< Index of an earlier group.
  bool isLockedAnyhow = false;        ///< True if it or a group that contains it is locked.
};

/// @param field  The array "groups".
std::vector<GroupEntry> readGroups(const JsonField& field);

/// @param field   The array "parts".
/// @param folder  Start of relative mesh paths.
std::vector<PartEntry> readParts(const JsonField& field, const std::vector<GroupEntry>& groups,
                                 const std::filesystem::path& folder, int version);

/// Reads the field "moving": index of the moving part in `entries`.
std::optional<std::size_t> readMovingPart(const JsonField& field, const std::vector<PartEntry>& entries,
                                          const std::vector<GroupEntry>& groups);

}  // namespace nearfit
