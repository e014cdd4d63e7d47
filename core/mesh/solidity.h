#pragma once

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Whether every piece of a mesh (triangles connected through vertices) is closed, oriented and of positive
/// volume: then minima find all that a body outside of it can touch. A cavity has negative volume, and so has
/// a piece that is inside out; which of the two a piece is would take knowing what it lies in. O(n).
bool isSolidThroughout(const TriangleMesh& mesh);

}  // namespace nearfit
