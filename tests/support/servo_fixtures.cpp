#include "tests/support/servo_fixtures.h"

#include "tests/support/mesh_generators.h"
#include "tests/support/part_geometries.h"

namespace nearfit::test {

PartGeometryPtr tipDownCone(const glm::dvec3& centre) {
  const RigidTransform upsideDown{glm::dquat(0.0, 1.0, 0.0, 0.0), {0.0, 0.0, 1.0}};
  return geometryOf(transformed(coneMesh(0.2, 1.0, 12), 1.0, upsideDown), centre);
}

PartGeometryPtr floorSlab() {
  return geometryOf(boxMesh({2.0, 2.0, 1.0}, {0.0, 0.0, -0.5}));
}

RigidTransform tipAt(double height) {
  return {glm::dquat(1.0, 0.0, 0.0, 0.0), {0.3, 0.1, height}};
}

std::unique_ptr<ServoScene> coneOverFloor() {
  static const PartGeometryPtr cone = tipDownCone(), slab = floorSlab();
  auto scene = std::make_unique<ServoScene>();
  scene->setMoving({PartId{2}, cone, tipAt(0.5)});
  scene->bodies.push_back({PartId{1}, slab, {}});
  return scene;
}

TrackedScene untrackedView(const ServoScene& scene) {
  return untracked(std::shared_ptr<const ServoScene>(std::shared_ptr<void>(), &scene));
}

}  // namespace nearfit::test
