#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/servo/proxy.h"
#include "core/servo/scene_tracker.h"

namespace nearfit::test {

/// A proxy in a scene of meshes, led by hand poses, with its scene tracked before each tick as the thread
/// beside the servo does it.
class ProxyWalk {
 public:
  struct Fixed {
    TriangleMesh mesh;
    RigidTransform worldFromBody;
  };

  ProxyWalk(std::vector<Fixed> bodies, TriangleMesh part, const RigidTransform& start,
            const ProxySettings& settings);

  /// One tick.
  const ProxyAccount& lead(const RigidTransform& hand);
  /// So many ticks with the hand at one place.
  void hold(const RigidTransform& hand, int ticks);

  /// Lets what the search ahead finds arrive so many ticks late from now on; 0: before the next tick.
  void setSearchTicks(std::size_t ticks) { searchTicks_ = ticks; }

  /// Puts a body elsewhere, or another one into the scene, as the user does while the servo runs.
  void moveBody(std::size_t index, const RigidTransform& worldFromBody);
  void addBody(const Fixed& body);
  /// Keeps the part on joints from now on.
  void setJoints(const JointSet& joints);

  const RigidTransform& pose() const { return proxy_.pose(); }
  Proxy& proxy() { return proxy_; }
  const TrackedScene& tracked() const { return tracked_; }
  const ServoScene& scene() const { return *scene_; }
  double margin() const { return settings_.margin; }
  ProxySettings& settings() { return settings_; }

 private:
  void setScene(std::shared_ptr<ServoScene> scene);

  ProxySettings settings_;
  std::shared_ptr<const ServoScene> scene_;
  SceneTracker tracker_;
  TrackedScene tracked_, found_;
  std::size_t searchTicks_ = 0;
  std::deque<TrackedScene> arriving_;  ///< What was found in the last ticks, if that takes some.
  Proxy proxy_;
  std::uint32_t nextId_ = 2;
};

}  // namespace nearfit::test
