#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/mesh/mesh_builder.h"
#include "core/progress.h"

namespace nearfit {

struct ImportedMesh {
  TriangleMesh mesh;
  MeshBuildReport report;
  std::string sha256;  ///< Of the file's bytes, 64 lower-case hexadecimal digits.
};

/// Reads STL (ASCII, binary), OBJ, PLY or OFF; the format is told by content where it can be, else by name.
/// Nothing that the file says is trusted. Memory stays within a few times the file's size.
/// Throws FileError naming the file, the line or byte, and the remedy; Cancelled.
ImportedMesh importMesh(const std::filesystem::path& file, const MeshBuildOptions& options,
                        const ProgressCallback& progress = {});

/// The same of a file's bytes that are in memory already. `file` says its name for the format and messages;
/// it is not opened.
ImportedMesh importMeshBytes(const std::filesystem::path& file, std::vector<char> bytes,
                             const MeshBuildOptions& options, const ProgressCallback& progress = {});

/// File name endings that importMesh knows, lower case without the dot.
const std::vector<std::string>& importableExtensions();

}  // namespace nearfit
