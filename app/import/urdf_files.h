#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/import/import_job.h"

namespace nearfit::importer {

/// Finds the files that a URDF file names, in its own package and in those it names that lie beside it, and nowhere
/// else: a file that somebody sent must not make this program open others.
///
/// Its own package is the nearest folder above it with a package.xml, else the folder that it is in, or the one above if
/// that is called urdf, robots or xacro, as is usual.
class UrdfFiles {
 public:
  /// Looks for the packages that the text names, before the sandbox closes.
  explicit UrdfFiles(const ImportJob& job);

  /// Folders of the packages.
  std::vector<std::filesystem::path> folders() const;

  /// A path, or why there is none.
  struct Found {
    std::filesystem::path path;
    std::string problem;
  };
  /// @param name  As in the file: a relative path, or package://PACKAGE/PATH.
  Found find(const std::string& name) const;

 private:
  std::filesystem::path packageOf(const std::string& name) const;

  std::filesystem::path folder_;  ///< That the file is in.
  std::filesystem::path root_;    ///< Of its own package.
  std::map<std::string, std::filesystem::path> packages_;
};

}  // namespace nearfit::importer
