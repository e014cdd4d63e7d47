#pragma once

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit::test {

/// Distance of a point to a mesh by brute force over all triangles, in extended precision; triangles without area count
/// as what they cover. Shares nothing with the engine but vertices and triangles.
double distanceToMesh(const TriangleMesh& mesh, const glm::dvec3& point);

}  // namespace nearfit::test
