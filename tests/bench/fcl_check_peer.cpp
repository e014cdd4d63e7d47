#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

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

  FclParts(const ManyPartsScene& scene, const std::vector<FclModelPtr>& models)
      : indices_(scene.parts.size()) {
    std::iota(indices_.begin(), indices_.end(), 0U);
    for (std::uint32_t& index : indices_) {
      const ManyPartsPlace& place = scene.parts[index];
      objects_.push_back(
          std::make_unique<fcl::CollisionObjectd>(models[place.mesh], toFcl(place.worldFromPart)));
      objects_.back()->setUserData(&index);
    }
  }

  std::vector<PeerIndices> pairsWithin(double threshold) const {
    fcl::DynamicAABBTreeCollisionManagerd manager;
    std::vector<fcl::CollisionObjectd*> objects;
    for (const auto& object : objects_)
      objects.push_back(object.get());
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
    return *static_cast<const std::uint32_t*>(object.getUserData());
  }
  /// Keeps FCL's traversal for the least distance from going below the threshold.
  static bool add(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data, double& distance) {
    auto& found = *static_cast<Found*>(data);
    distance = found.threshold;
    if (a->getAABB().distance(b->getAABB()) <= found.threshold)
      found.pairs.emplace_back(indexOf(*a), indexOf(*b));
    return false;
  }

  std::vector<std::uint32_t> indices_;  ///< The objects' user data.
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
};

}  // namespace

CheckPeer fclCheckPeer() {
  return {"fcl", measurePeer<FclParts>};
}

}  // namespace nearfit::bench
