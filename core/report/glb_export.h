#pragma once

#include <filesystem>
#include <span>

#include "core/base/progress.h"
#include "core/report/mesh_export.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Writes parts as a self-contained glTF 2.0 file (.glb), atomically, and returns its size.
///
/// - Metres. Up is y in glTF and z in a scene: the root node, of the file's name, turns the whole by -90 degrees about x.
/// - Groups are nodes without a transform, parts are nodes with their worldFromPart as rotation and translation, in double
///   precision; both have their names.
/// - Vertices are in the part's frame, in single precision. Each geometry is written once. Parts that have the same
///   geometry, colour and opacity share a mesh; others share its accessors.
/// - Normals are split along sharp edges (shadedMesh()); triangles of faces with a colour of their own are primitives of
///   their own. Materials show both sides of meshes that are not closed.
///
/// Source: Khronos Group, glTF 2.0 Specification, 2021.
/// @param scene  Has the moving part where it is now (placedScene()).
/// @param parts  Of the scene; see chosenParts().
/// Throws FileError; UsageError (no parts, more than 4 GiB); Cancelled, which keeps the old file. Blocking; memory grows
/// with the size of the meshes.
MeshExportSize exportGlb(const Scene& scene, std::span<const Scene::PartPtr> parts,
                         const std::filesystem::path& file, const ProgressCallback& progress = {});

}  // namespace nearfit
