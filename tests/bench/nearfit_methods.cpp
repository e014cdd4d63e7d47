#include <limits>

#include "core/proximity/lmd_query.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench {
namespace {

/// Minima that a query may return: more than any scene here has.
constexpr std::size_t kCapacity = 65536;

/// The full set at each pose, from nothing.
class ColdQuery : public QueryMethod {
 public:
  explicit ColdQuery(const PreparedScene& scene) : scene_(scene), scratch_(kCapacity), lmds_(kCapacity) {}

  Answer query(const RigidTransform& sceneFromPart) override {
    const LmdResult result =
        findLmds(scene_.sceneTree, scene_.partTree, sceneFromPart, scene_.cutoff, scratch_, lmds_);
    return {result.count > 0 ? lmds_.front().distance : std::numeric_limits<double>::infinity(), result.count,
            result.status == QueryStatus::Complete};
  }

 private:
  const PreparedScene& scene_;
  LmdScratch scratch_;
  std::vector<Lmd> lmds_;
};

constexpr double kTolerance = 1e-9;

}  // namespace

std::vector<MethodEntry> nearfitMethods() {
  return {{"nearfit-cold", AnswerKind::FullSet, "all local minimum distances within the cutoff, no memory",
           kTolerance, [](const PreparedScene& scene) { return std::make_unique<ColdQuery>(scene); }}};
}

std::vector<BuildEntry> nearfitBuilds() {
  return {
      {"nearfit-tree",
       [](const TriangleMesh& mesh) -> BuiltHierarchy {
         const auto tree = std::make_shared<const NormalConeTree>(mesh);
         return {tree, tree->byteSize()};
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
