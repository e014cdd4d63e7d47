#pragma once

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Whether a mesh is closed and oriented and its outer side is seen wherever a body outside of it can be:
/// then minima find all that such a body can touch.
///
/// Each piece (triangles connected through edges) has positive volume and crosses itself nowhere, or winds
/// around no point a negative number of times, certainly (outer_windings.h). A piece that is inside out has
/// negative volume, and so has a cavity; which of the two it is would take knowing what it lies in. Pieces
/// may cross each other. False where there is doubt: a volume within rounding of zero, too many crossings. On
/// all processors, not for the GUI's thread nor the servo's: O(n log n), a second or so for a million
/// triangles; O(n) where pieces have no such volume, at once where the mesh is not closed and oriented.
bool isSolidThroughout(const TriangleMesh& mesh);

}  // namespace nearfit
