#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/servo/servo_scene.h"
#include "tests/bench/far_parts.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench {

/// A part in hand and one near it, with any number of others around them that are never near on the way
/// along a path.
struct NearPair {
  /// @param path  Its first pose is where the part in hand begins.
  NearPair(const PreparedScene& prepared, std::span<const RigidTransform> path);

  /// The two have the same ids and places in all scenes.
  std::shared_ptr<const ServoScene> sceneWith(std::size_t farCount) const;

  PartGeometryPtr scene, part;
  RigidTransform start;
  FarField field;
  std::vector<PartGeometryPtr> others;
};

}  // namespace nearfit::bench
