#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "core/mesh/exact_surface.h"
#include "core/mesh/triangle_mesh.h"

/// Coarse meshes whose faces know their exact surfaces.
namespace nearfit::test {

struct ExactSolid {
  TriangleMesh mesh;
  SurfaceFaces surfaces;
};

/// A solid about z: rings of corners at radius and z of each point of the profile, from below, joined by bands, and
/// flat ends. Band i, between rings i and i + 1, has triangles 2 * (i * segments + s) and the next for each segment s;
/// then come those of the lower and of the upper end, a fan each.
/// @param faceOfBand  Index into `surfaces` for each band. The ends are two further faces, planes.
/// @param segments  Around the axis; >= 3.
ExactSolid turnedSolid(std::span<const glm::dvec2> profile, std::vector<ExactSurface> surfaces,
                       std::span<const std::uint32_t> faceOfBand, std::uint32_t segments);

/// The same solid elsewhere.
ExactSolid moved(const ExactSolid& solid, const RigidTransform& motion);

/// A surface about z: of a cylinder, a torus about the point (0, 0, height), a sphere about it, or a cone with its apex
/// there that opens towards +z if its angle is positive.
ExactSurface cylinderAboutZ(double radius, bool isHollow = false);
ExactSurface torusAboutZ(double height, double radius, double minorRadius);
ExactSurface sphereAboutZ(double height, double radius);
ExactSurface coneAboutZ(double apexHeight, double angle);

}  // namespace nearfit::test
