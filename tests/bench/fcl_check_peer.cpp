#include <cstdint>
#include <memory>
#include <utility>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "tests/bench/check_peer.h"
#include "tests/bench/fcl_bodies.h"
#include "tests/bench/peer_check.h"

namespace nearfit::bench {
namespace {

using FclModelPtr = std::shared_ptr<FclModel>;

class FclParts {
 public:
  static std::vector<FclModelPtr> makeModels(std::span<const TriangleMesh> meshes) {
    return peerModels(meshes, [](const TriangleMesh& mesh) { return FclModelPtr(fclModelOf(mesh)); });
  }

  FclParts(const ManyPartsScene& scene, const std::vector<FclModelPtr>& models) {
    for (const ManyPartsPlace& place : scene.parts)
      objects_.push_back(
          std::make_unique<fcl::CollisionObjectd>(models[place.mesh], toFcl(place.worldFromPart)));
  }

  std::vector<PeerIndices> pairsWithin(double threshold) const {
    fcl::DynamicAABBTreeCollisionManagerd manager;
    std::vector<fcl::CollisionObjectd*> objects;
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      objects_[i]->setUserData(reinterpret_cast<void*>(static_cast<std::uintptr_t>(i)));
      objects.push_back(objects_[i].get());
    }
    manager.registerObjects(objects);
    manager.setup();
    Found found{threshold, {}};
    manager.distance(&found, add);
    return std::move(found.pairs);
  }

  double distance(const PeerIndices& pair, double within) const {
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    // Bounds its search, as a user would who wants no more.
    result.min_distance = within;
    fcl::distance(objects_[pair.first].get(), objects_[pair.second].get(), request, result);
    return result.min_distance;
  }

  bool doMeet(const PeerIndices& pair) const {
    const fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    return fcl::collide(objects_[pair.first].get(), objects_[pair.second].get(), request, result) > 0;
  }

 private:
  struct Found {
    double threshold;
    std::vector<PeerIndices> pairs;
  };
  static std::uint32_t indexOf(const fcl::CollisionObjectd& object) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(object.getUserData()));
  }
  /// Keeps FCL's traversal for the least distance from going below the threshold.
  static bool add(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data, double& distance) {
    auto& found = *static_cast<Found*>(data);
    distance = found.threshold;
    if (a->getAABB().distance(b->getAABB()) <= found.threshold)
      found.pairs.emplace_back(indexOf(*a), indexOf(*b));
    return false;
  }

  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
};

}  // namespace

CheckPeer fclCheckPeer() {
  return {"fcl", measurePeer<FclParts>};
}

}  // namespace nearfit::bench
