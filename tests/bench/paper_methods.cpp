#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "tests/bench/error_method.h"
#include "tests/bench/paper_hierarchy.h"
#include "tests/bench/peer_bodies.h"
#include "tests/bench/query_method.h"

namespace nearfit::bench {
namespace {

/// Its answer to a conforming pair of more takes seconds.
constexpr std::size_t kMaxPaperTriangles = 20'000;
/// It promises no distance: what it accepts depends on normals, and on open meshes may leave out the nearest pair.
constexpr double kNoPromise = std::numeric_limits<double>::infinity();

template <PaperRule Rule>
struct PaperBodies {
  explicit PaperBodies(const PreparedScene& prepared)
      : scene(prepared.meshes.scene, Rule), part(prepared.meshes.part, Rule) {}
  PaperHierarchy scene, part;
};

template <PaperRule Rule>
class PaperMethod : public QueryMethod {
 public:
  PaperMethod(std::shared_ptr<const PaperBodies<Rule>> bodies, double cutoff)
      : bodies_(std::move(bodies)), cutoff_(cutoff), query_(bodies_->scene, bodies_->part) {}

  Answer query(const RigidTransform& sceneFromPart) override {
    const std::span<const PaperMinimum> found = query_.find(sceneFromPart, cutoff_);
    return {found.empty() ? std::numeric_limits<double>::infinity() : found.front().distance, found.size(),
            true};
  }

 private:
  std::shared_ptr<const PaperBodies<Rule>> bodies_;
  double cutoff_;
  PaperQuery query_;
};

template <PaperRule Rule>
MethodEntry paperEntry(const char* name, const char* description) {
  const auto cache = std::make_shared<PeerBodiesCache<PaperBodies<Rule>>>();
  return {name, AnswerKind::OtherRule, description, kNoPromise, [cache](const PreparedScene& scene) {
            return std::make_unique<PaperMethod<Rule>>(cache->of(scene), scene.cutoff);
          }};
}

class PaperErrorMethod : public ErrorMethod {
 public:
  PaperErrorMethod(const ErrorScene& scene, PaperRule rule)
      : scene_(scene),
        sceneHierarchy_(scene.bodies.meshes.scene, rule),
        partHierarchy_(scene.bodies.meshes.part, rule),
        query_(sceneHierarchy_, partHierarchy_) {}

  void answer(const RigidTransform& sceneFromPart, ContactAnswer& answer) override {
    for (const PaperMinimum& m : query_.find(sceneFromPart, scene_.bodies.cutoff)) {
      Lmd& lmd = answer.minima.emplace_back();
      lmd.scenePoint = m.scenePoint;
      lmd.partPoint = m.partPoint;
      lmd.distance = m.distance;
      lmd.direction = m.direction;
    }
    answer.wrench = scene_.wrenchOf(answer.minima, sceneFromPart);
  }

  std::size_t byteSize() const override { return sceneHierarchy_.byteSize() + partHierarchy_.byteSize(); }

 private:
  const ErrorScene& scene_;
  PaperHierarchy sceneHierarchy_, partHierarchy_;
  PaperQuery query_;
};

ErrorMethodEntry paperErrorEntry(const char* name, const char* description, PaperRule rule) {
  return {name,
          description,
          1,
          false,
          [rule](const ErrorScene& scene) { return std::make_unique<PaperErrorMethod>(scene, rule); },
          kMaxPaperTriangles};
}

}  // namespace

std::vector<MethodEntry> paperMethods() {
  return {
      paperEntry<PaperRule::NormalSpans>(
          "paper-spans",
          "Johnson and Willemsen (2003), spheres, cones and triangles; normals' spans at the nearest points"),
      paperEntry<PaperRule::NormalCones>("paper-cones",
                                         "the same; cones of the triangles' face and vertex normals"),
      paperEntry<PaperRule::AllPairs>("paper-pairs",
                                      "all pairs of triangles within the cutoff, by the same hierarchy")};
}

std::vector<ErrorMethodEntry> paperErrorMethods() {
  return {
      paperErrorEntry("paper spans",
                      "the paper's algorithm on its own hierarchy; spans of normals at the nearest points",
                      PaperRule::NormalSpans),
      paperErrorEntry("paper cones", "the same; cones of the triangles' face and vertex normals",
                      PaperRule::NormalCones)};
}

ErrorMethodEntry allPairsErrorMethod() {
  return paperErrorEntry("all pairs", "all pairs of triangles within the cutoff, by the same hierarchy",
                         PaperRule::AllPairs);
}

}  // namespace nearfit::bench
