#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "core/mesh/exact_surface.h"
#include "core/mesh/triangle_mesh.h"
#include "core/placing/feature.h"
#include "core/section/mesh_section.h"

namespace nearfit {

/// Kinds of features to look for.
enum class FeatureFilter : std::uint8_t {
  Any,     ///< The first found of: corner, edge or circle, wall (cylinder, cone, sphere, torus), flat face.
  Faces,   ///< Flat faces, including facets of something round whose exact surface is not known.
  Axes,    ///< Cylinders, cones, tori, circles and edges, and prisms of six flats or more.
  Rounds,  ///< Cylinders, cones, tori and circles.
  Points,  ///< Corners and centres of circles and spheres; otherwise the point itself.
};

/// A point where a ray or the mouse hits a mesh, in the mesh's frame.
struct SurfaceHit {
  std::uint32_t triangle = 0;
  glm::dvec3 point{0.0};  ///< [m]
};

/// The feature that a user points at; std::nullopt if there is none of that kind.
///
/// A flat face is a set of connected triangles in one plane, a cylinder or cone one on such a wall (a ring of at least
/// eight facets, or an arc of at least four fine ones), a circle or edge a chain of sharp edges, which those between
/// facets of a wall are not. The flats of a prism with four, six or seven are flat faces; its axis is found only where
/// axes are looked for.
///
/// With exact surfaces, a face on a plane, cylinder, cone, sphere or torus gives the feature of that surface, however
/// coarse its facets and however little of it there is, along with neighbouring faces on the same surface. An edge then
/// lies between two surfaces, and is the circle or line in which they meet if they determine one (surface_pairs.h).
/// Spheres and tori are found only so. Faces on other surfaces are looked at as without.
///
/// Takes some milliseconds for features with tens of thousands of triangles: for the GUI thread, not the servo thread.
/// @param hit    Its triangle is one of the mesh.
/// @param reach  Max distance from the point to corners and edges [m]; >= 0.
/// @param surfaces  Of the mesh's faces, one for each triangle; null, or of kind Other alone, if none are known.
std::optional<PickedFeature> pickFeature(const TriangleMesh& mesh, const SurfaceHit& hit, double reach,
                                         FeatureFilter filter = FeatureFilter::Any,
                                         const SurfaceFaces* surfaces = nullptr);

/// The feature that a user points at on a cap: a nearby segment of the outline, as an edge, otherwise the
/// point itself. std::nullopt for FeatureFilter::Faces and Rounds, and for Axes if no segment is near.
/// @param point  On the cap, in the mesh's frame [m]; set to the nearest point of the segment found.
/// @param reach  Max distance to the outline [m]; >= 0.
std::optional<PickedFeature> pickFeature(const MeshSection& section, glm::dvec3& point, double reach,
                                         FeatureFilter filter = FeatureFilter::Any);

}  // namespace nearfit
