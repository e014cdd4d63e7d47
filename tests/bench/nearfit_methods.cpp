#include <limits>
#include <span>

#include "core/mesh/flat_mesh.h"
#include "core/proximity/query/blocked_minima.h"
#include "core/proximity/query/lmd_query.h"
#include "tests/bench/query_method.h"
#include "tests/bench/tracked_query.h"

namespace nearfit::bench {
namespace {

/// The full set at each pose, from nothing.
class ColdQuery : public QueryMethod {
 public:
  /// Whether minima are then marked that are blocked, and what is known of the bodies when they are.
  enum class Marking { None, AnyPose, BodiesApart };

  ColdQuery(const PreparedScene& scene, Marking marking)
      : scene_(scene), marking_(marking), scratch_(kQueryCapacity), lmds_(kQueryCapacity) {}

  Answer query(const RigidTransform& sceneFromPart) override {
    const LmdResult result =
        findLmds(scene_.sceneTree, scene_.partTree, sceneFromPart, scene_.cutoff, scratch_, lmds_);
    const double distance =
        result.count > 0 ? lmds_.front().distance : std::numeric_limits<double>::infinity();
    if (marking_ != Marking::None) {
      markBlocked(scene_.sceneTree, scene_.partTree, sceneFromPart, std::span(lmds_).first(result.count),
                  marking_ == Marking::BodiesApart ? distance : 0.0, scratch_);
    }
    return {distance, result.count, result.status == QueryStatus::Complete};
  }

 private:
  const PreparedScene& scene_;
  Marking marking_;
  LmdScratch scratch_;
  std::vector<Lmd> lmds_;
};

constexpr double kTolerance = 1e-9;

}  // namespace

std::vector<MethodEntry> nearfitMethods() {
  const auto cold = [](ColdQuery::Marking marking) {
    return [marking](const PreparedScene& scene) { return std::make_unique<ColdQuery>(scene, marking); };
  };
  return {{"nearfit-cold", AnswerKind::FullSet, "all local minimum distances within the cutoff, no memory",
           kTolerance, cold(ColdQuery::Marking::None)},
          {"nearfit-cold-blocked", AnswerKind::FullSet, "the same, each marked if it is blocked", kTolerance,
           cold(ColdQuery::Marking::AnyPose)},
          {"nearfit-cold-blocked-apart", AnswerKind::FullSet,
           "the same, where the bodies are known not to interpenetrate", kTolerance,
           cold(ColdQuery::Marking::BodiesApart)},
          {"nearfit-tracked", AnswerKind::FullSet,
           "the full set from lists that another thread renews; its time is not counted, its delay is",
           kTolerance, [](const PreparedScene& scene) { return std::make_unique<TrackedQuery>(scene); }}};
}

NormalConeTree searchedTree(const TriangleMesh& mesh) {
  // The numbers of generated meshes are exact.
  return NormalConeTree(mergeFlats(mesh, 0.0));
}

std::vector<BuildEntry> nearfitBuilds() {
  return {
      {"nearfit-tree",
       [](const TriangleMesh& mesh) -> BuiltHierarchy {
         const auto tree = std::make_shared<const NormalConeTree>(searchedTree(mesh));
         const bool hasOwnMesh = !tree->mesh().sharesArraysOf(mesh);
         return {tree, tree->byteSize() + (hasOwnMesh ? tree->mesh().byteSize() : 0)};
       }},
      {"nearfit-adjacency",
       [](const TriangleMesh& mesh) -> BuiltHierarchy {
         const auto points = mesh.vertices();
         const auto faces = mesh.triangles();
         const auto copy =
             std::make_shared<const TriangleMesh>(std::vector<glm::dvec3>(points.begin(), points.end()),
                                                  std::vector<Triangle>(faces.begin(), faces.end()));
         return {copy, copy->byteSize()};
       }},
  };
}

}  // namespace nearfit::bench
