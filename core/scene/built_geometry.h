#pragma once

#include <filesystem>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"
#include "core/scene/part_geometry.h"

namespace nearfit {

/// A geometry of triangles that no file holds, made as buildMesh() makes one of a file's: equal vertices are merged, faces
/// without area dropped, closed shells turned outside out. Its `file` is empty.
/// @param vertices  [m]
/// Throws Error if nothing is left, or an index is out of range.
PartGeometryPtr builtGeometry(std::vector<glm::dvec3> vertices, const std::vector<Triangle>& triangles);

/// The same geometry as that of a file that holds its mesh in metres.
/// @param file  A mesh file that was written of it (exportMesh()). Throws FileError if it cannot be read.
PartGeometryPtr namedGeometry(const PartGeometry& built, const std::filesystem::path& file);

}  // namespace nearfit
