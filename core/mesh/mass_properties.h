#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

enum class MassBasis {
  VolumeIntegrals,  ///< Exact for the closed, oriented mesh.
  OrientedBox,      ///< The mesh encloses no volume: its oriented bounding box stands in for it.
};

/// Of a body of unit density, in the mesh's frame.
struct MassProperties {
  double volume = 0.0;      ///< [m^3]
  glm::dvec3 centre{0.0};   ///< Centre of mass [m].
  glm::dmat3 inertia{0.0};  ///< About the centre, for density 1 kg/m^3 [kg m^2].
  MassBasis basis = MassBasis::OrientedBox;
};

/// Volume integrals where the mesh is closed, oriented and of positive volume, else the oriented bounding box
/// (its thickness padded to a small fraction of its length, so that inertia is never singular).
/// Source: B. Mirtich, Fast and accurate computation of polyhedral mass properties, 1996; deviation: the
/// integrals are summed over tetrahedra between the faces and the centre of the bounding box, not over
/// projected faces. theorem).
MassProperties massProperties(const TriangleMesh& mesh);

}  // namespace nearfit
