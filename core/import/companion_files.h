#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nearfit {

/// Limits of the companions of a document: a robot has some hundred meshes. Their names fit into a text of the cache
/// (kMaxCachedTextBytes).
constexpr std::size_t kMaxCompanions = 10'000, kMaxCompanionNameBytes = 1000;

/// True if a document may name a companion so: printable UTF-8 within the limit, and no absolute path.
bool isCompanionName(std::string_view name);

/// True if documents of this name may have companions: glTF and URDF.
bool mayHaveCompanions(const std::filesystem::path& document);

/// True if meshes of this name are read for a URDF file: mesh files and glTF, not compressed.
bool isMeshForUrdf(const std::filesystem::path& file);

/// Meshes that a URDF file names, as far as they are there and can be read for it, found as UrdfFiles finds them. The file
/// is not parsed: one that is damaged may give some. Empty for documents of other formats, and for one that cannot be
/// read or is larger than a URDF file gets. Throws nothing but std::bad_alloc.
std::vector<std::filesystem::path> meshFilesNamedIn(const std::filesystem::path& document);

/// A path, or why there is none.
struct FoundFile {
  std::filesystem::path path;
  std::string problem;
};

/// Finds the files that a URDF file names, in its own package and in those it names that lie beside it, and nowhere
/// else: a file that somebody sent must not make this program open others.
///
/// Its own package is the nearest folder above it with a package.xml, else the folder that it is in, or the one above if
/// that is called urdf, robots or xacro, as is usual.
class UrdfFiles {
 public:
  /// Looks for the packages that the text names.
  UrdfFiles(const std::filesystem::path& file, std::string_view text);

  /// Folders of the packages.
  std::vector<std::filesystem::path> folders() const;

  /// @param name  As in the file: a relative path, or package://PACKAGE/PATH.
  FoundFile find(const std::string& name) const;

 private:
  std::filesystem::path packageOf(const std::string& name) const;

  std::filesystem::path folder_;  ///< That the file is in.
  std::filesystem::path root_;    ///< Of its own package.
  std::map<std::string, std::filesystem::path> packages_;
};

/// Finds the companions of a document in the same way whether it is imported or taken from the cache: those of a glTF
/// file in its folder, those of a URDF file as UrdfFiles does, links followed.
class CompanionFinder {
 public:
  /// @param names  All that will be looked for.
  CompanionFinder(const std::filesystem::path& document, std::span<const std::string> names);

  FoundFile find(const std::string& name) const;

 private:
  std::filesystem::path folder_;
  std::optional<UrdfFiles> urdf_;
};

}  // namespace nearfit
