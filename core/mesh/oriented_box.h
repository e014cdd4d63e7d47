#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// A box in the mesh's frame.
struct OrientedBox {
  glm::dvec3 centre{0.0};    ///< [m]
  glm::dmat3 axes{1.0};      ///< Columns: unit, mutually perpendicular, right-handed.
  glm::dvec3 halfSize{0.0};  ///< Along the axes [m].

  double volume() const noexcept { return 8.0 * halfSize.x * halfSize.y * halfSize.z; }
};

/// Returns a tight box around a mesh: the smallest of those along the coordinate axes, the principal axes of
/// the surface, and the sides of its largest triangles (exact for a mesh with a boxy outline). Not always the
/// minimum box. A mesh without triangles gives an empty box at the origin. O(n).
OrientedBox orientedBox(const TriangleMesh& mesh);

}  // namespace nearfit
