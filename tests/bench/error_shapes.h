#pragma once

#include <cstdint>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

/// Solids of known shape, tessellated the finer the larger `fineness` is: each edge of the tessellation is
/// 1/fineness as long as at 1. All vertices are on the surface, so that facets of what bulges lie inside the
/// solid by up to their sagitta, and those of a bowl stand out of it. Closed, outward faces, in metres.
namespace nearfit::bench {

/// About the origin.
TriangleMesh ellipsoidMesh(const glm::dvec3& halfAxes, std::uint32_t fineness);

/// About z, in the middle. @param majorSegments, minorSegments  At a fineness of 1.
TriangleMesh fineTorusMesh(double majorRadius, double minorRadius, std::uint32_t majorSegments,
                           std::uint32_t minorSegments, std::uint32_t fineness);

/// About z, in the middle; caps of rings.
TriangleMesh fineCylinderMesh(double radius, double height, std::uint32_t fineness);

/// About z, base at z = 0, apex at z = height.
TriangleMesh fineConeMesh(double radius, double height, std::uint32_t fineness);

/// About z: what is within `radius` of the segment from -halfLength to halfLength.
TriangleMesh capsuleMesh(double radius, double halfLength, std::uint32_t fineness);

/// The lower half (z <= 0) of a hollow ball about the origin.
TriangleMesh bowlMesh(double innerRadius, double outerRadius, std::uint32_t fineness);

/// About the origin; 12 fineness^2 faces.
TriangleMesh fineBoxMesh(const glm::dvec3& size, std::uint32_t fineness);

/// A body of revolution about z. @param profile  (radius, z) with the solid on its left; begins and ends on
/// the axis, touches it nowhere else.
TriangleMesh revolvedMesh(std::span<const glm::dvec2> profile, std::uint32_t around);

double longestEdge(const TriangleMesh& mesh);

}  // namespace nearfit::bench
