#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

/// Whether surfaces meet, and how near they are, by the definition, in rational arithmetic.
namespace nearfit::test {

/// Whether two triangles, of no area too, have a point in common: whether zero is in the hull of the
/// differences of their corners, that is, of one to four of them that are independent (Caratheodory).
bool doMeetExactly(const std::array<glm::dvec3, 3>& a, const std::array<glm::dvec3, 3>& b);

/// Over all pairs of triangles, the part's vertices rounded to double where `sceneFromPart` places them.
bool doSurfacesMeetExactly(const TriangleMesh& scene, const TriangleMesh& part,
                           const RigidTransform& sceneFromPart);

/// Least distance of two triangles with areas [m], to the nearest double or its neighbour.
double exactDistance(const std::array<glm::dvec3, 3>& a, const std::array<glm::dvec3, 3>& b);

/// Least distance of the surfaces [m], the part's vertices rounded as above. Only pairs whose boxes are
/// nearer than what is found are looked at.
double leastDistanceExactly(const TriangleMesh& scene, const TriangleMesh& part,
                            const RigidTransform& sceneFromPart);

/// How many times the triangles wind around a point, by the sum of the angles that they fill seen from it
/// (van Oosterom & Strackee 1983): a whole number for closed meshes, up to rounding.
double windingNumber(const TriangleMesh& mesh, const glm::dvec3& point);

}  // namespace nearfit::test
