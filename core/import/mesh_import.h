#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "core/math/aabb.h"
#include "core/mesh/mesh_builder.h"

namespace nearfit {

/// A mesh read from a file, in metres.
struct ImportedMesh {
  TriangleMesh mesh;
  MeshBuildReport report;
  std::string sha256;  ///< Of the file's bytes, 64 lower-case hexadecimal digits.
};

/// Reads STL (ASCII or binary), OBJ, PLY or OFF, also compressed by gzip. Detects the format by content if possible, else by the file
/// name. Robust against malformed and malicious files; memory stays within a few times the file's size.
/// Throws FileError naming the file, the line or byte, and the remedy; UsageError if an option is
/// invalid; Cancelled.
ImportedMesh importMesh(const std::filesystem::path& file, const MeshBuildOptions& options,
                        const ProgressCallback& progress = {});

/// Like importMesh(), for a file's bytes in memory. `file` only names the format and appears in messages;
/// it is not opened.
ImportedMesh importMeshBytes(const std::filesystem::path& file, std::vector<char> bytes,
                             const MeshBuildOptions& options, const ProgressCallback& progress = {});

/// The polygons of a mesh file as it has them.
struct ImportedPolygons {
  PolygonSoup soup;
  std::string sha256;  ///< The file's bytes hashed, 64 lower-case hexadecimal digits.
};

/// Reads the polygons of a mesh file as importMesh() does, but builds no mesh. Throws FileError, Cancelled.
ImportedPolygons importPolygons(const std::filesystem::path& file, const ProgressCallback& progress = {});

/// Bounding box of a mesh file's faces, in the file's units; empty if no corner is finite. Reads the file as
/// importMesh() does but builds no mesh, which takes most of the time. Throws FileError, Cancelled.
Aabb readMeshBounds(const std::filesystem::path& file, const ProgressCallback& progress = {});

/// File name extensions that importMesh() can read: lower case, without the dot.
const std::vector<std::string>& importableExtensions();

}  // namespace nearfit
