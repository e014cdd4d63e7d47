#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"

/// Deterministic meshes of known shape, in metres. Closed ones are manifold with outward faces.
namespace nearfit::test {

/// A regular tetrahedron inscribed in the sphere of radius `radius` about the origin; 4 faces.
TriangleMesh tetrahedronMesh(double radius = 1.0);

/// An axis-aligned box; 12 faces.
TriangleMesh boxMesh(const glm::dvec3& size, const glm::dvec3& centre = glm::dvec3(0.0));

/// A sphere about the origin of meridians and parallels with poles on z; 2 * segments * (rings - 1) faces.
/// @param segments  Around the axis; >= 3.   @param rings  From pole to pole; >= 2.
TriangleMesh uvSphereMesh(double radius, std::uint32_t segments, std::uint32_t rings);

/// A sphere about the origin: an icosahedron subdivided with its vertices on the sphere; 20 * 4^subdivisions
/// faces.
TriangleMesh icosphereMesh(double radius, std::uint32_t subdivisions);

/// A torus about the z axis; 2 * majorSegments * minorSegments faces.
/// @param majorRadius  From the axis to the tube's centre line.   @param minorRadius  Of the tube; smaller.
TriangleMesh torusMesh(double majorRadius, double minorRadius, std::uint32_t majorSegments,
                       std::uint32_t minorSegments);

/// A cylinder about z from -height/2 to height/2, its caps fans of triangles about a middle vertex; a disc
/// when it is flat. 4 * segments faces.
TriangleMesh cylinderMesh(double radius, double height, std::uint32_t segments);

/// A tube (a bore) about z from -height/2 to height/2; 8 * segments faces.
TriangleMesh tubeMesh(double innerRadius, double outerRadius, double height, std::uint32_t segments);

/// A solid about z with flat ends: rings joined by bands; 2 * segments * rings faces.
/// @param profile  Radius, > 0, and z of each ring, from the lower end; no two neighbours are the same.
TriangleMesh turnedMesh(std::span<const glm::dvec2> profile, std::uint32_t segments);

/// A cone about z, its base at z = 0 and its apex at z = height; 2 * segments faces.
TriangleMesh coneMesh(double radius, double height, std::uint32_t segments);

/// Half a hollow sphere about the origin, open towards +z, solid between its walls; 4 * segments * rings
/// faces. The inner wall has the vertices of the lower half of uvSphereMesh(inner, segments, 2 * rings).
TriangleMesh bowlMesh(double inner, double outer, std::uint32_t segments, std::uint32_t rings);

/// A closed, jagged, star-shaped mesh about the origin: an icosphere whose vertices are moved along their
/// rays by independent uniform factors in [1 - roughness, 1 + roughness]; roughness in [0, 1). Same seed,
/// same mesh.
TriangleMesh starMesh(std::uint64_t seed, double radius, std::uint32_t subdivisions, double roughness);

/// An open, flat square of side `size` in z = 0 about the origin facing +z; 2 * divisions^2 faces.
TriangleMesh squareMesh(double size, std::uint32_t divisions);

/// Each triangle split into four by the middles of its sides, `times` over: the same surface.
TriangleMesh subdivided(const TriangleMesh& mesh, std::uint32_t times);

/// The same surface, its edges cut at random places again and again: small and large triangles side by side, and
/// slivers. O(cuts * triangles). Same seed, same mesh.
TriangleMesh cutUnevenly(const TriangleMesh& mesh, std::size_t cuts, std::uint64_t seed);

/// Vertices scaled about the origin (scale > 0), then moved.
TriangleMesh transformed(const TriangleMesh& mesh, double scale, const RigidTransform& motion = {});

/// Both meshes in one, a's triangles first; their vertices are not shared.
TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b);

/// All faces turned round.
TriangleMesh turned(const TriangleMesh& mesh);

}  // namespace nearfit::test
