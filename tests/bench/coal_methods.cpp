#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <coal/collision.h>
#include <coal/distance.h>
#include <coal/internal/intersect.h>

#include "tests/bench/coal_bodies.h"
#include "tests/bench/peer_bodies.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench {
namespace {

struct CoalBodies {
  explicit CoalBodies(const PreparedScene& prepared)
      : scene(coalModelOf(prepared.meshes.scene)), part(coalModelOf(prepared.meshes.part)) {}
  std::unique_ptr<CoalModel> scene, part;
};
using CoalBodiesPtr = std::shared_ptr<const CoalBodies>;

/// The least distance over all triangles.
class CoalDistance : public QueryMethod {
 public:
  CoalDistance(CoalBodiesPtr bodies, bool isSeeded) : bodies_(std::move(bodies)), isSeeded_(isSeeded) {}

  Answer query(const RigidTransform& sceneFromPart) override {
    const coal::Transform3s pose = toCoal(sceneFromPart);
    const coal::DistanceRequest request;
    coal::DistanceResult result;
    if (isSeeded_ && hasAnswer_) {
      result.min_distance = distanceOfLastTriangles(pose);
      result.b1 = sceneTriangle_;
      result.b2 = partTriangle_;
    }
    coal::distance(bodies_->scene.get(), coal::Transform3s(), bodies_->part.get(), pose, request, result);
    sceneTriangle_ = result.b1;
    partTriangle_ = result.b2;
    hasAnswer_ = true;
    return {result.min_distance, 1, true};
  }

 private:
  /// An upper bound: where the triangles that were nearest are now.
  double distanceOfLastTriangles(const coal::Transform3s& pose) const {
    const coal::Triangle& s = (*bodies_->scene->tri_indices)[static_cast<std::size_t>(sceneTriangle_)];
    const coal::Triangle& t = (*bodies_->part->tri_indices)[static_cast<std::size_t>(partTriangle_)];
    const auto &sv = *bodies_->scene->vertices, &tv = *bodies_->part->vertices;
    coal::Vec3s p, q;
    return std::sqrt(coal::TriangleDistance::sqrTriDistance(sv[s[0]], sv[s[1]], sv[s[2]], tv[t[0]], tv[t[1]],
                                                            tv[t[2]], pose, p, q));
  }

  CoalBodiesPtr bodies_;
  bool isSeeded_, hasAnswer_ = false;
  int sceneTriangle_ = 0, partTriangle_ = 0;
};

/// All pairs of triangles within the cutoff, as contacts within a security margin.
class CoalPairs : public QueryMethod {
 public:
  CoalPairs(CoalBodiesPtr bodies, double cutoff) : bodies_(std::move(bodies)) {
    request_.num_max_contacts = std::numeric_limits<int>::max();
    request_.enable_contact = true;
    request_.security_margin = cutoff;
  }

  Answer query(const RigidTransform& sceneFromPart) override {
    result_.clear();
    coal::collide(bodies_->scene.get(), coal::Transform3s(), bodies_->part.get(), toCoal(sceneFromPart),
                  request_, result_);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < result_.numContacts(); ++i)
      least = std::min(least, result_.getContact(i).penetration_depth);
    return {least, result_.numContacts(), true};
  }

 private:
  CoalBodiesPtr bodies_;
  coal::CollisionRequest request_;
  coal::CollisionResult result_;
};

/// Distances of triangles are direct; contacts come from an iteration (GJK) to a tolerance of 1e-6.
constexpr double kTolerance = 1e-9, kIterativeTolerance = 1e-4;

}  // namespace

std::vector<MethodEntry> coalMethods() {
  const auto cache = std::make_shared<PeerBodiesCache<CoalBodies>>();
  return {
      {"coal-seeded", AnswerKind::Distance,
       "Coal's least distance, bounded by the last nearest triangles at the new pose", kTolerance,
       [cache](const PreparedScene& scene) {
         return std::make_unique<CoalDistance>(cache->of(scene), true);
       }},
      {"coal", AnswerKind::Distance, "Coal's least distance", kTolerance,
       [cache](const PreparedScene& scene) {
         return std::make_unique<CoalDistance>(cache->of(scene), false);
       }},
      {"coal-pairs", AnswerKind::Pairs, "Coal's contacts within a margin of the cutoff", kIterativeTolerance,
       [cache](const PreparedScene& scene) {
         return std::make_unique<CoalPairs>(cache->of(scene), scene.cutoff);
       }},
  };
}

std::vector<BuildEntry> coalBuilds() {
  return {{"coal", [](const TriangleMesh& mesh) -> BuiltHierarchy {
             const std::shared_ptr<const CoalModel> model = coalModelOf(mesh);
             const std::size_t bytes = sizeof(coal::BVNode<coal::OBBRSS>) * model->getNumBVs() +
                                       sizeof(coal::Triangle) * model->num_tris +
                                       sizeof(coal::Vec3s) * model->num_vertices;
             return {model, bytes};
           }}};
}

}  // namespace nearfit::bench
