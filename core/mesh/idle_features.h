#pragma once

#include "core/mesh/features.h"

namespace nearfit {

/// Adds to what findFeatures gives, behind the rest of their kind, the vertices and edges that it leaves out
/// as they cannot carry a minimum: reflex and flat edges, and vertices whose polar cone is empty, flat or in
/// the material. Each has the bound of directions that a hierarchy would give it that knows nothing of this:
/// what holds the normals of its faces, as in Johnson & Cohen 2001. Edges and vertices around which the
/// surface has no side are not added.
void addIdleFeatures(const TriangleMesh& mesh, MeshFeatures& features);

}  // namespace nearfit
