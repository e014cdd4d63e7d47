#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include <fcl/narrowphase/detail/primitive_shape_algorithm/triangle_distance.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/detail/traversal/distance/mesh_distance_traversal_node.h>
#include <fcl/narrowphase/distance.h>

#include "tests/bench/fcl_bodies.h"
#include "tests/bench/peer_bodies.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench {
namespace {

struct FclBodies {
  explicit FclBodies(const PreparedScene& prepared)
      : scene(fclModelOf(prepared.meshes.scene)), part(fclModelOf(prepared.meshes.part)) {}
  std::unique_ptr<FclModel> scene, part;
};
using FclBodiesPtr = std::shared_ptr<const FclBodies>;

/// The least distance over all triangles.
class FclDistance : public QueryMethod {
 public:
  FclDistance(FclBodiesPtr bodies, bool isSeeded) : bodies_(std::move(bodies)), isSeeded_(isSeeded) {}

  Answer query(const RigidTransform& sceneFromPart) override {
    const fcl::Transform3d pose = toFcl(sceneFromPart);
    const fcl::DistanceRequestd request;
    fcl::DistanceResultd result;
    if (isSeeded_ && hasAnswer_) {
      result.min_distance = distanceOfLastTriangles(pose);
      result.b1 = sceneTriangle_;
      result.b2 = partTriangle_;
    }
    fcl::distance(bodies_->scene.get(), fcl::Transform3d::Identity(), bodies_->part.get(), pose, request,
                  result);
    sceneTriangle_ = result.b1;
    partTriangle_ = result.b2;
    hasAnswer_ = true;
    return {result.min_distance, 1, true};
  }

 private:
  /// An upper bound: where the triangles that were nearest are now.
  double distanceOfLastTriangles(const fcl::Transform3d& pose) const {
    const fcl::Triangle& s = bodies_->scene->tri_indices[sceneTriangle_];
    const fcl::Triangle& t = bodies_->part->tri_indices[partTriangle_];
    const fcl::Vector3d *sv = bodies_->scene->vertices, *tv = bodies_->part->vertices;
    fcl::Vector3d p, q;
    return fcl::detail::TriangleDistance<double>::triDistance(sv[s[0]], sv[s[1]], sv[s[2]], tv[t[0]],
                                                              tv[t[1]], tv[t[2]], pose, p, q);
  }

  FclBodiesPtr bodies_;
  bool isSeeded_, hasAnswer_ = false;
  std::intptr_t sceneTriangle_ = 0, partTriangle_ = 0;
};

/// FCL's traversal for distances, kept from stopping at the least one.
class FclPairsNode : public fcl::detail::MeshDistanceTraversalNodeOBBRSSd {
 public:
  FclPairsNode(double cutoff, std::vector<std::pair<int, int>>& pairs) : cutoff_(cutoff), pairs_(pairs) {}

  bool canStop(double bound) const override { return bound > cutoff_; }

  void leafTesting(int b1, int b2) const override {
    const int i = model1->getBV(b1).primitiveId(), j = model2->getBV(b2).primitiveId();
    const fcl::Triangle &s = tri_indices1[i], &t = tri_indices2[j];
    fcl::Vector3d p, q;
    const double d = fcl::detail::TriangleDistance<double>::triDistance(
        vertices1[s[0]], vertices1[s[1]], vertices1[s[2]], vertices2[t[0]], vertices2[t[1]], vertices2[t[2]],
        tf, p, q);
    if (d > cutoff_) return;
    pairs_.emplace_back(i, j);
    least_ = std::min(least_, d);
  }

  double least() const { return least_; }

 private:
  double cutoff_;
  std::vector<std::pair<int, int>>& pairs_;
  mutable double least_ = std::numeric_limits<double>::infinity();
};

/// All pairs of triangles within the cutoff. FCL has no query for that; its own traversal does it.
class FclPairs : public QueryMethod {
 public:
  FclPairs(FclBodiesPtr bodies, double cutoff) : bodies_(std::move(bodies)), cutoff_(cutoff) {}

  Answer query(const RigidTransform& sceneFromPart) override {
    pairs_.clear();
    FclPairsNode node(cutoff_, pairs_);
    fcl::DistanceResultd ignored;
    fcl::detail::initialize(node, *bodies_->scene, fcl::Transform3d::Identity(), *bodies_->part,
                            toFcl(sceneFromPart), fcl::DistanceRequestd(), ignored);
    fcl::detail::distance(&node);
    return {node.least(), pairs_.size(), true};
  }

 private:
  FclBodiesPtr bodies_;
  double cutoff_;
  std::vector<std::pair<int, int>> pairs_;
};

constexpr double kTolerance = 1e-9;

}  // namespace

std::vector<MethodEntry> fclMethods() {
  const auto cache = std::make_shared<PeerBodiesCache<FclBodies>>();
  return {
      {"fcl-seeded", AnswerKind::Distance,
       "FCL's least distance, bounded by the last nearest triangles at the new pose", kTolerance,
       [cache](const PreparedScene& scene) { return std::make_unique<FclDistance>(cache->of(scene), true); }},
      {"fcl", AnswerKind::Distance, "FCL's least distance", kTolerance,
       [cache](const PreparedScene& scene) {
         return std::make_unique<FclDistance>(cache->of(scene), false);
       }},
      {"fcl-pairs", AnswerKind::Pairs, "all pairs of triangles within the cutoff, by FCL's traversal",
       kTolerance,
       [cache](const PreparedScene& scene) {
         return std::make_unique<FclPairs>(cache->of(scene), scene.cutoff);
       }},
  };
}

std::vector<BuildEntry> fclBuilds() {
  return {{"fcl", [](const TriangleMesh& mesh) -> BuiltHierarchy {
             const std::shared_ptr<const FclModel> model = fclModelOf(mesh);
             const std::size_t bytes =
                 sizeof(fcl::BVNode<fcl::OBBRSSd>) * static_cast<std::size_t>(model->getNumBVs()) +
                 sizeof(fcl::Triangle) * static_cast<std::size_t>(model->num_tris) +
                 sizeof(fcl::Vector3d) * static_cast<std::size_t>(model->num_vertices);
             return {model, bytes};
           }}};
}

}  // namespace nearfit::bench
