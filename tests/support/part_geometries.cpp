#include "tests/support/part_geometries.h"

#include <utility>

#include "core/mesh/mass_properties.h"

namespace nearfit::test {

namespace {

PartGeometryPtr withMass(TriangleMesh mesh, const MassProperties& mass) {
  return std::make_shared<const PartGeometry>(PartGeometry{.file = "/generated.obj",
                                                           .sha256 = std::string(64, '0'),
                                                           .metresPerUnit = 1.0,
                                                           .mesh = std::move(mesh),
                                                           .report = {},
                                                           .mass = mass});
}

}  // namespace

PartGeometryPtr freshGeometryOf(TriangleMesh mesh, const glm::dvec3& centre) {
  MassProperties mass;
  mass.volume = 1.0;
  mass.centre = centre;
  mass.inertia = glm::dmat3(1.0);
  mass.basis = MassBasis::VolumeIntegrals;
  return withMass(std::move(mesh), mass);
}

PartGeometryPtr solidGeometryOf(TriangleMesh mesh) {
  const MassProperties mass = massProperties(mesh);
  return withMass(std::move(mesh), mass);
}

PartGeometryPtr geometryOf(TriangleMesh mesh, const glm::dvec3& centre) {
  PartGeometryPtr geometry = freshGeometryOf(std::move(mesh), centre);
  geometry->tree();
  return geometry;
}

Part partOf(PartGeometryPtr geometry, const char* name, const RigidTransform& worldFromPart) {
  Part part;
  part.name = name;
  part.geometry = std::move(geometry);
  part.worldFromPart = worldFromPart;
  return part;
}

}  // namespace nearfit::test
