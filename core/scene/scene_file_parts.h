#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/scene/group.h"
#include "core/scene/part.h"
#include "core/text/json_file.h"

/// Parts and groups of a scene file (scene_file.h has the format), checked, no mesh loaded yet; for its
/// reader alone. Each function throws FileError naming the field that is missing or wrong.
namespace nearfit {

/// A part as the file says it, its mesh not loaded yet.
struct PartEntry {
  JsonField field;
  Part part;                         ///< Its group not set.
  std::optional<std::size_t> group;  ///< Which of the groups.
  std::filesystem::path mesh;
  std::string sha256;
  double metresPerUnit;
};

/// A group as the file says it.
struct GroupEntry {
  Group group;                        ///< Its parent not set.
  std::optional<std::size_t> parent;  ///< Which of the groups before it.
  bool isLockedAnyhow = false;        ///< It, or one that it is in.
};

/// @param field  The array "groups".
std::vector<GroupEntry> readGroups(const JsonField& field);

/// @param field   The array "parts".
/// @param folder  That mesh paths start from.
std::vector<PartEntry> readParts(const JsonField& field, const std::vector<GroupEntry>& groups,
                                 const std::filesystem::path& folder, int version);

/// Index of the moving part among the entries, from the field "moving".
std::optional<std::size_t> readMovingPart(const JsonField& field, const std::vector<PartEntry>& entries,
                                          const std::vector<GroupEntry>& groups);

}  // namespace nearfit
