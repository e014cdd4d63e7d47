#include "tests/bench/near_pair.h"

#include <utility>

#include "tests/bench/scene_path.h"
#include "tests/support/part_geometries.h"

namespace nearfit::bench {

NearPair::NearPair(const PreparedScene& prepared, std::span<const RigidTransform> path)
    : scene(test::freshGeometryOf(prepared.meshes.scene)),
      part(test::freshGeometryOf(prepared.meshes.part)),
      start(path.front()),
      others(farGeometries(prepared.size)) {
  field.keepOut = ballAround(pathBodies(prepared.meshes), path);
  field.keepOut.radius += prepared.cutoff;
  field.size = prepared.size;
  field.spacing *= prepared.size;
}

std::shared_ptr<const ServoScene> NearPair::sceneWith(std::size_t farCount) const {
  Scene all;
  // First, so that they have the same ids and places in all.
  all.add(test::partOf(scene, "near"));
  all.setMovingPart(all.add(test::partOf(part, "in hand", start)));
  for (Part& far : farParts(field, others, farCount))
    all.add(std::move(far));
  return makeServoScene(all);
}

}  // namespace nearfit::bench
