#include "core/servo/servo_bodies.h"

#include <vector>

namespace nearfit {

void addBodies(ServoScene& servo, const Scene& scene, const std::function<bool(PartId)>& isMoved,
               const ProgressCallback& progress) {
  servo.bodies.reserve(scene.parts().size());
  std::vector<PartGeometryPtr> geometries{servo.moving.geometry};
  for (const Scene::PartPtr& part : scene.parts()) {
    if (isMoved(part->id) || !part->isVisible || part->geometry == nullptr) continue;
    servo.bodies.push_back({part->id, part->geometry, part->worldFromPart});
    geometries.push_back(part->geometry);
  }
  // Waiting is allowed here, but not in a tick.
  prepareHierarchies(geometries, progress);
  servo.prepareSurfaces();
}

}  // namespace nearfit
