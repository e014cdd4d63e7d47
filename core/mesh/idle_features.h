#pragma once

#include "core/mesh/features.h"

namespace nearfit {

/// Adds the vertices and edges that findFeatures() omits because they cannot carry a minimum: reflex and flat
/// edges, and vertices whose polar cone is empty, flat or in the material. They go behind the features of
/// their kind. Their cones are what a hierarchy without that knowledge would use: bounds of the normals of
/// their faces, as in Johnson & Cohen 2001. Omits edges and vertices where the surface has no side. For
/// measurements only.
void addIdleFeatures(const TriangleMesh& mesh, MeshFeatures& features);

}  // namespace nearfit
