#pragma once

#include <memory>

#include "tests/bench/query_method.h"

namespace nearfit::bench {

/// Makes a library's hierarchies once for all its methods that measure one scene, and lets go of them with
/// the last of these. @tparam Bodies  Constructed of a PreparedScene.
template <typename Bodies>
class PeerBodiesCache {
 public:
  std::shared_ptr<const Bodies> of(const PreparedScene& scene) {
    std::shared_ptr<const Bodies> bodies = bodies_.lock();
    if (!bodies || scene_ != &scene) bodies = std::make_shared<const Bodies>(scene);
    bodies_ = bodies;
    scene_ = &scene;
    return bodies;
  }

 private:
  std::weak_ptr<const Bodies> bodies_;
  const PreparedScene* scene_ = nullptr;
};

}  // namespace nearfit::bench
