#pragma once

#include <filesystem>

#include "core/path/assembly_path.h"
#include "core/scene/scene.h"
#include "tests/support/temporary_folder.h"

namespace nearfit::bench {

/// Files of a path and what it is about.
struct PathFiles {
  std::filesystem::path scene, path, certificate;
  double certifySeconds = 0.0;  ///< Time of `nearfit-cli certify` as a process, from files [s].
};

/// Writes scene, meshes and path to files, and runs `nearfit-cli certify`. Throws Error with what the program says if the
/// path is not certified.
/// @param separation  [m]
PathFiles writePathFiles(const std::filesystem::path& cli, const Scene& scene, const AssemblyPath& path,
                         double separation, const test::TemporaryFolder& folder);

/// Times of `nearfit-cli certify` and `nearfit-cli verify` as processes, from files [s].
struct PathProcessTimes {
  double certify = 0.0, verify = 0.0;
};

/// Writes scene, meshes and path to files and runs both: reading and hierarchies are counted, nothing comes from the
/// cache. Throws Error with what the program says if the path is not certified or its certificate is refused.
/// @param separation  [m]
PathProcessTimes timePathProcesses(const std::filesystem::path& cli, const Scene& scene,
                                   const AssemblyPath& path, double separation);

}  // namespace nearfit::bench
