#pragma once

#include <optional>
#include <vector>

#include "core/base/progress.h"
#include "core/proximity/cache/tree_cache.h"
#include "core/scene/part_geometry.h"

namespace nearfit {

/// The name of a geometry: all but its mesh and what is derived from that, with other repairs.
PartGeometry namedAs(const PartGeometry& geometry, MeshRepairs repairs);

/// Mesh of a geometry of which the name is set, from the cache; no value if it is not there.
std::optional<CachedMesh> cachedMeshOf(const PartGeometry& named);

/// Caches the mesh of a geometry of which the name is set. Mesh files of few triangles are not cached; shapes of
/// documents are: most parts of an assembly are small, and one that is missing takes an import of the whole.
void storeMesh(const PartGeometry& named, const CachedMesh& mesh);

/// Completes a geometry of which the name is set by a mesh and what loading found out about it. Its hierarchy will be
/// looked up in the cache, and kept there, when it is first needed.
PartGeometryPtr cachedGeometry(PartGeometry named, CachedMesh loaded);

/// The mesh of a geometry, and what loading found out about it, as the cache keeps it.
CachedMesh toCache(const PartGeometry& geometry);

/// Repairs a mesh that was read from a file, and all that is known of it: warnings, mass, faces. Triangles that fill a
/// hole get a face of their own. The result does not depend on where the mesh came from.
/// Throws FileError that names the file if no face would be left, UsageError, Cancelled.
std::vector<RepairStep> repairCached(const std::filesystem::path& file, const MeshRepairs& repairs,
                                     const ProgressCallback& progress, CachedMesh& mesh);

}  // namespace nearfit
