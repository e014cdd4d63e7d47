#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <coal/broadphase/broadphase_dynamic_AABB_tree.h>
#include <coal/collision.h>
#include <coal/distance.h>

#include "tests/bench/check_peer.h"
#include "tests/bench/coal_bodies.h"
#include "tests/bench/peer_check.h"

namespace nearfit::bench {
namespace {

using CoalModelPtr = std::shared_ptr<CoalModel>;

/// Max length of a list of pairs of triangles: some 500 MB, in each thread.
constexpr std::size_t kMaxListed = std::size_t{1} << 22;

std::uint32_t indexOfCoal(const coal::CollisionObject& object) {
  return *static_cast<const std::uint32_t*>(object.getUserData());
}

/// Keeps Coal's traversal for the least distance from going below the threshold.
struct CoalPairsWithin : coal::DistanceCallBackBase {
  explicit CoalPairsWithin(double within) : threshold(within) {}

  bool distance(coal::CollisionObject* a, coal::CollisionObject* b, coal::CoalScalar& least) override {
    least = threshold;
    if (a->getAABB().distance(b->getAABB()) <= threshold)
      pairs.emplace_back(indexOfCoal(*a), indexOfCoal(*b));
    return false;
  }

  double threshold;
  std::vector<PeerIndices> pairs;
};

class CoalParts {
 public:
  static std::vector<CoalModelPtr> makeModels(std::span<const TriangleMesh> meshes) {
    return peerModels(meshes, [](const TriangleMesh& mesh) { return CoalModelPtr(coalModelOf(mesh)); });
  }

  CoalParts(const ManyPartsScene& scene, const std::vector<CoalModelPtr>& models)
      : indices_(scene.parts.size()) {
    std::iota(indices_.begin(), indices_.end(), 0U);
    for (std::uint32_t& index : indices_) {
      const ManyPartsPlace& place = scene.parts[index];
      objects_.push_back(
          std::make_unique<coal::CollisionObject>(models[place.mesh], toCoal(place.worldFromPart)));
      objects_.back()->setUserData(&index);
    }
  }

  std::vector<PeerIndices> pairsWithin(double threshold) const {
    coal::DynamicAABBTreeCollisionManager manager;
    std::vector<coal::CollisionObject*> objects;
    for (const auto& object : objects_)
      objects.push_back(object.get());
    manager.registerObjects(objects);
    manager.setup();
    CoalPairsWithin found(threshold);
    manager.distance(&found);
    return std::move(found.pairs);
  }

  double distance(const PeerIndices& pair, double within) const {
    // A depth of what overlaps is not asked for.
    const coal::DistanceRequest request(true, false);
    coal::DistanceResult result;
    // Bounds its search, as a user would who wants no more.
    result.min_distance = within;
    coal::distance(objects_[pair.first].get(), objects_[pair.second].get(), request, result);
    return result.min_distance;
  }

  bool doMeet(const PeerIndices& pair) const {
    const coal::CollisionRequest request;
    coal::CollisionResult result;
    return coal::collide(objects_[pair.first].get(), objects_[pair.second].get(), request, result) > 0;
  }

 protected:
  std::vector<std::uint32_t> indices_;  ///< The objects' user data.
  std::vector<std::unique_ptr<coal::CollisionObject>> objects_;
};

/// Lists pairs of triangles too.
class CoalLists : public CoalParts {
 public:
  using CoalParts::CoalParts;

  double distance(const PeerIndices& pair, double within) const {
    const double least = CoalParts::distance(pair, within);
    if (least < within) list(pair, within);
    return least;
  }
  void addCounts(PeerCheck& check) const {
    check.listed = listed_;
    check.fullLists = full_;
  }

 private:
  void list(const PeerIndices& pair, double within) const {
    // Neither depths of triangles that meet nor distances of those beyond the threshold are asked for.
    coal::CollisionRequest request(coal::NO_REQUEST, kMaxListed);
    request.security_margin = request.distance_upper_bound = within;
    coal::CollisionResult result;
    const std::size_t found =
        coal::collide(objects_[pair.first].get(), objects_[pair.second].get(), request, result);
    listed_ += found;
    if (found >= kMaxListed) ++full_;
  }

  mutable std::atomic<std::size_t> listed_{0}, full_{0};
};

}  // namespace

CheckPeer coalCheckPeer() {
  return {"coal", measurePeer<CoalParts>};
}

CheckPeer coalListsPeer() {
  return {"coal-lists", measurePeer<CoalLists>};
}

}  // namespace nearfit::bench
