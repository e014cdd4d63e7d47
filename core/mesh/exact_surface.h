#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace nearfit {

/// Kinds of surfaces whose exact shape is kept with the triangles that stand for them.
enum class SurfaceKind : std::uint8_t { Other, Plane, Cylinder, Cone, Sphere, Torus };

/// The surface that a face of a CAD model lies on, in the part's frame [m].
struct ExactSurface {
  SurfaceKind kind = SurfaceKind::Other;
  /// Plane: a point of it. Cylinder: a point of the axis. Cone: apex. Sphere and torus: centre.
  glm::dvec3 point{0.0};
  /// Unit vector. Plane: normal, outward from the material. Cylinder, cone, torus: along the axis, for a cone from the
  /// apex into the half that the face is on. Zero for a sphere and for Other.
  glm::dvec3 direction{0.0};
  double radius = 0.0;       ///< Cylinder, sphere; torus: from the centre to the middle of its tube [m].
  double minorRadius = 0.0;  ///< Torus: of its tube [m].
  double halfAngle = 0.0;    ///< Cone: between axis and surface, above 0 and below pi/2 [rad].
  bool isHollow = false;     ///< The material is on the outer side, as around a bore.

  bool operator==(const ExactSurface&) const = default;
};

/// Faces of a CAD model, each on one surface, and the triangles that stand for them.
struct SurfaceFaces {
  std::vector<ExactSurface> faces;
  /// Index into `faces` for each triangle of the mesh.
  std::vector<std::uint32_t> faceOfTriangle;
};

/// Turns faces inside out where a mesh has had most of their triangles turned round.
/// @param agreement  For each face: sum over its triangles of the product of new and old normal; below 0: turned.
void turnFaces(std::span<ExactSurface> faces, std::span<const double> agreement) noexcept;

}  // namespace nearfit
