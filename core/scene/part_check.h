#pragma once

#include "core/mesh/check/mesh_check.h"
#include "core/scene/part_geometry.h"

namespace nearfit {

/// Checks the mesh of a part, and adds the faces that loading has left out, with their places if its file is a mesh
/// file and still the one that was read. Blocking, up to some seconds for a million triangles; one thread. Throws UsageError (checkMesh),
/// Cancelled.
MeshCheck checkPart(const PartGeometry& geometry, const MeshCheckOptions& options = {},
                    const ProgressCallback& progress = {});

}  // namespace nearfit
