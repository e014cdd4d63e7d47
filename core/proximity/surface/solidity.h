#pragma once

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// True if a mesh is closed and oriented, and shows its outer side wherever a body outside it can be. Then
/// minima include everything that such a body can touch.
///
/// Each component (triangles connected through edges) must have positive volume; if it crosses itself, it
/// must certainly wind around no point a negative number of times (outer_windings.h). A component that is
/// inside out has negative volume, and so has a cavity; telling them apart would take knowing what they lie
/// in. Components may cross each other. False in doubt: a volume within rounding of zero, too many crossings,
/// or more work than self_crossings.h allows.
/// Runs on all processors; not for the GUI or servo thread. O(n log n), about a second for a million
/// triangles; O(n) if a volume is not positive, immediate if the mesh is not closed and oriented.
bool isSolidThroughout(const TriangleMesh& mesh);

}  // namespace nearfit
