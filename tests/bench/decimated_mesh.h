#pragma once

#include <cstddef>

#include "core/mesh/triangle_mesh.h"

namespace nearfit::bench {

/// A mesh of that many times fewer triangles, or as many more as its shape cannot do without: edges are
/// collapsed in the order of the quadric error, onto vertices that there are, where no triangle turns over.
/// Closed meshes stay closed. Meshes of fewer than 48 triangles, a floor or a box, stay as they are.
/// Source: Garland & Heckbert 1997, as OpenMesh has it. Throws Error when OpenMesh does not take the mesh (it
/// must be manifold).
TriangleMesh decimatedMesh(const TriangleMesh& mesh, std::size_t factor);

}  // namespace nearfit::bench
