#pragma once

#include <filesystem>
#include <span>

#include "core/base/progress.h"
#include "core/report/mesh_export.h"
#include "core/scene/scene.h"

namespace nearfit {

/// Writes parts as a 3MF file, atomically, and returns its size.
///
/// - Numbers have the fewest digits that read back as the same double, which lib3mf would cut to single precision.
/// - Groups are objects of components without a transform. A part is an object of its name; parts that share a geometry
///   and a colour are objects of one component each, which is the geometry's mesh. Transforms are the parts' worldFromPart.
/// - Colours and opacities are base materials: of objects, and of triangles of faces with a colour of their own. The format
///   gives a colour to meshes alone, so that parts of one geometry in other colours have a mesh of their own.
/// - Closed meshes are of type "model", others of type "surface", which slicers leave out.
///
/// Source: 3MF Consortium, 3D Manufacturing Format Core Specification 1.3.
/// @param scene          Has the moving part where it is now (placedScene()).
/// @param parts          Of the scene; see chosenParts().
/// @param metresPerUnit  Unit of the numbers: a micrometre, millimetre, centimetre, inch, foot or metre.
/// Throws FileError; UsageError (another unit, no parts, more than 4 GiB); Cancelled, which keeps the old file. Blocking.
/// Memory grows with the size of the meshes.
MeshExportSize exportThreeMf(const Scene& scene, std::span<const Scene::PartPtr> parts, double metresPerUnit,
                             const std::filesystem::path& file, const ProgressCallback& progress = {});

}  // namespace nearfit
