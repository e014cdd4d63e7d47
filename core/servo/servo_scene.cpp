#include "core/servo/servo_scene.h"

#include "core/base/error.h"

namespace nearfit {

void ServoScene::setMoving(const Body& body) {
  moving = body;
  if (!body.geometry) return;
  centreInPart = body.geometry->mass.centre;
  metric = massMetric(body.geometry->mass, body.geometry->mesh);
}

void ServoScene::setJoints(const JointSet& set) noexcept {
  areJointsContradictory = set.isContradictory();
  joints = areJointsContradictory ? JointSet() : set;
}

void ServoScene::prepareSurfaces() {
  if (!moving.geometry) return;
  for (Body& body : bodies) {
    if (moving.geometry->isSolid() && body.geometry->isSolid()) continue;
    body.surface = body.geometry->surface();
    moving.surface = moving.geometry->surface();
  }
}

double ServoScene::deviation(const Body& other) const noexcept {
  return other.geometry->tree().deviation() + moving.geometry->tree().deviation();
}

std::unique_ptr<const ServoScene> makeServoScene(const Scene& scene) {
  const Part* moving = scene.movingPart() ? scene.find(*scene.movingPart()) : nullptr;
  if (moving == nullptr || moving->geometry == nullptr) {
    throw UsageError("scene", "no part is in hand", "choose the moving part first");
  }
  auto result = std::make_unique<ServoScene>();
  result->setMoving({moving->id, moving->geometry, moving->worldFromPart});
  result->mass = massOf(*moving);
  result->setJoints(jointsOf(scene, moving->id));
  if (!moving->isVisible) return result;
  result->bodies.reserve(scene.parts().size());
  for (const Scene::PartPtr& part : scene.parts()) {
    if (part->id == moving->id || !part->isVisible || part->geometry == nullptr) continue;
    result->bodies.push_back({part->id, part->geometry, part->worldFromPart});
  }
  // Waiting is allowed here, but not in a tick.
  std::vector<PartGeometryPtr> geometries{moving->geometry};
  for (const ServoScene::Body& body : result->bodies)
    geometries.push_back(body.geometry);
  prepareHierarchies(geometries);
  result->prepareSurfaces();
  return result;
}

}  // namespace nearfit
