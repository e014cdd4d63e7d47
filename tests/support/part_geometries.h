#pragma once

#include "core/scene/part_geometry.h"
#include "core/scene/scene.h"

namespace nearfit::test {

/// Geometry around a generated mesh, as if it had been loaded from a file that does not exist, its hierarchy
/// not built yet. Its centre of mass is `centre`.
PartGeometryPtr freshGeometryOf(TriangleMesh mesh, const glm::dvec3& centre = glm::dvec3(0.0));

/// As freshGeometryOf, with the mass properties of the mesh itself.
PartGeometryPtr solidGeometryOf(TriangleMesh mesh);

/// As freshGeometryOf, with its hierarchy.
PartGeometryPtr geometryOf(TriangleMesh mesh, const glm::dvec3& centre = glm::dvec3(0.0));

/// A part to be added to a scene.
Part partOf(PartGeometryPtr geometry, const char* name, const RigidTransform& worldFromPart = {});

}  // namespace nearfit::test
