#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// How mass properties were computed.
enum class MassBasis {
  VolumeIntegrals,  ///< Exact for the closed, oriented mesh.
  OrientedBox,      ///< The mesh encloses no volume; computed from its oriented bounding box.
};

/// "volume integrals" or "oriented box".
const char* nameOf(MassBasis basis) noexcept;

/// Mass properties at unit density (1 kg/m^3), in the mesh's frame.
struct MassProperties {
  double volume = 0.0;      ///< [m^3]
  glm::dvec3 centre{0.0};   ///< Centre of mass [m].
  glm::dmat3 inertia{0.0};  ///< About the centre of mass, axes of the mesh's frame [kg m^2].
  MassBasis basis = MassBasis::OrientedBox;
};

/// Computes volume integrals if the mesh is closed, oriented and of positive volume. Otherwise uses its
/// oriented bounding box, padded to a small fraction of its length so that inertia is never singular. O(n).
/// Source: B. Mirtich, Fast and accurate computation of polyhedral mass properties, 1996. Deviation: sums
/// over tetrahedra between the faces and the centre of the bounding box, not over projected faces.
MassProperties massProperties(const TriangleMesh& mesh);

}  // namespace nearfit
