#include "core/servo/servo_scene.h"

#include <algorithm>
#include <utility>

#include "core/servo/servo_bodies.h"

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

PartId ServoScene::memberAt(FeatureKind kind, std::uint32_t index) const noexcept {
  if (members.empty()) return moving.id;
  if (kind == FeatureKind::Edge) index = moving.geometry->tree().mesh().edges()[index].v0;
  const auto end = kind == FeatureKind::Face ? &BodyMember::triangleEnd : &BodyMember::vertexEnd;
  const auto member = std::ranges::upper_bound(members, index, {}, end);
  return member != members.end() ? member->id : moving.id;
}

double ServoScene::deviation(const Body& other) const noexcept {
  return other.geometry->tree().deviation() + moving.geometry->tree().deviation();
}

std::unique_ptr<ServoScene> makeServoScene(const Scene& scene) {
  MovingBody moving = movingBody(scene);
  auto result = std::make_unique<ServoScene>();
  result->setMoving({moving.id, moving.geometry, moving.worldFromBody});
  result->members = std::move(moving.members);
  result->mass = moving.mass;
  result->setJoints(jointsOfMoving(scene));
  if (moving.isVisible) addBodies(*result, scene, [&](PartId id) { return scene.isMoving(id); });
  return result;
}

}  // namespace nearfit
