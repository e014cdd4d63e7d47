#include "tests/support/proxy_walk.h"

#include <optional>
#include <utility>

#include "tests/support/part_geometries.h"

namespace nearfit::test {

ProxyWalk::ProxyWalk(std::vector<Fixed> bodies, TriangleMesh part, const RigidTransform& start,
                     const ProxySettings& settings)
    : settings_(settings) {
  auto scene = std::make_shared<ServoScene>();
  scene->setMoving({PartId{1}, solidGeometryOf(std::move(part)), start});
  for (Fixed& body : bodies)
    scene->bodies.push_back({PartId{nextId_++}, solidGeometryOf(std::move(body.mesh)), body.worldFromBody});
  setScene(std::move(scene));
  proxy_.place(start);
}

void ProxyWalk::setScene(std::shared_ptr<ServoScene> scene) {
  scene->moving.geometry->tree();
  for (const ServoScene::Body& body : scene->bodies)
    body.geometry->tree();
  scene->prepareSurfaces();
  scene_ = std::move(scene);
  tracker_.setScene(scene_);
}

const ProxyAccount& ProxyWalk::lead(const RigidTransform& hand) {
  const SearchReach reach{20.0 * settings_.margin, kContactReach * settings_.margin};
  const ProxyAccount& last = proxy_.account();
  tracker_.update({proxy_.pose(), std::nullopt, last.isWaiting, last.isStarved, proxy_.isCrowded()}, 1.0);
  if (tracker_.isDue(reach)) tracker_.refresh(reach, searchTicks_ == 0 ? tracked_ : found_);
  if (searchTicks_ > 0) {
    arriving_.push_back(found_.scene ? found_ : tracked_);
    if (arriving_.size() > searchTicks_) {
      tracked_ = std::move(arriving_.front());
      arriving_.pop_front();
    }
  }
  proxy_.follow(tracked_, hand, settings_);
  return proxy_.account();
}

void ProxyWalk::hold(const RigidTransform& hand, int ticks) {
  for (int i = 0; i < ticks; ++i)
    lead(hand);
}

void ProxyWalk::moveBody(std::size_t index, const RigidTransform& worldFromBody) {
  auto scene = std::make_shared<ServoScene>(*scene_);
  scene->bodies[index].worldFromPart = worldFromBody;
  setScene(std::move(scene));
}

void ProxyWalk::addBody(const Fixed& body) {
  auto scene = std::make_shared<ServoScene>(*scene_);
  scene->bodies.push_back({PartId{nextId_++}, solidGeometryOf(body.mesh), body.worldFromBody});
  setScene(std::move(scene));
}

void ProxyWalk::setJoints(const JointSet& joints) {
  auto scene = std::make_shared<ServoScene>(*scene_);
  scene->setJoints(joints);
  setScene(std::move(scene));
}

}  // namespace nearfit::test
