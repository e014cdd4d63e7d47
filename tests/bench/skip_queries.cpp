#include <memory>
#include <vector>

#include <fmt/format.h>

#include "core/proximity/query/blocked_minima.h"
#include "core/proximity/query/lmd_query.h"
#include "tests/bench/bench_scene.h"
#include "tests/bench/digest.h"
#include "tests/bench/scene_path.h"
#include "tests/bench/selection.h"
#include "tests/bench/skips.h"
#include "tests/support/idle_features.h"

namespace nearfit::bench {
namespace {

const std::vector<std::string> kScenes{"gear-disc", "crankshaft-gear", "teapot-spring", "organic-70k"};
const std::vector<std::string> kMeshes{"gear-6k", "spring-24k", "organic-70k"};

/// Cold queries of two hierarchies of one kind.
template <class Hierarchy>
class ColdWay {
 public:
  ColdWay(const Hierarchy& scene, const Hierarchy& part, double cutoff)
      : scene_(scene), part_(part), cutoff_(cutoff), scratch_(kQueryCapacity), lmds_(kQueryCapacity) {}

  void find(const RigidTransform& pose) {
    found_ = findLmds(scene_, part_, pose, cutoff_, scratch_, lmds_);
    leafPairs_ += static_cast<double>(found_.leafPairs);
    queries_ += 1.0;
  }
  void mark(const RigidTransform& pose, double apart) {
    markBlocked(scene_, part_, pose, std::span(lmds_).first(found_.count), apart, scratch_);
  }
  std::uint64_t digest() const {
    Digest digest;
    digest.add(std::span<const Lmd>(lmds_).first(found_.count));
    return digest.value();
  }
  /// Least distance, or the cutoff.
  double distance() const { return found_.count > 0 ? lmds_.front().distance : cutoff_; }
  /// Of features, tested exactly.
  double pairsPerQuery() const { return leafPairs_ / queries_; }

 private:
  const Hierarchy &scene_, &part_;
  double cutoff_;
  LmdScratch scratch_;
  std::vector<Lmd> lmds_;
  LmdResult found_;
  double leafPairs_ = 0.0, queries_ = 0.0;
};

std::string featuresRemark(const NormalConeTree& tree) {
  return fmt::format("{} of {} features", tree.allFeatures().total() - tree.keptFeatures().total(),
                     tree.allFeatures().total());
}

SkipRow queryWithoutFeatures(const SceneEntry& entry, const SkipOptions& options) {
  const PreparedScene prepared(entry.make(), kUsualCutoffFraction);
  const std::vector<RigidTransform> path = makePath(prepared, options.path);
  const test::FullHierarchy scene(prepared.sceneTree.mesh()), part(prepared.partTree.mesh());
  ColdWay with(prepared.sceneTree, prepared.partTree, prepared.cutoff);
  ColdWay without(scene, part, prepared.cutoff);
  SkipRow row{"features", entry.name, "cold query", {}, {}, {}};
  row.with.bytes = prepared.sceneTree.byteSize() + prepared.partTree.byteSize();
  row.without.bytes = scene.tree().byteSize() + part.tree().byteSize();
  takeTurns(row, path.size(), {[&](std::size_t i) { with.find(path[i]); }, [&] { return with.digest(); }},
            {[&](std::size_t i) { without.find(path[i]); }, [&] { return without.digest(); }}, options.run);
  row.remark =
      fmt::format("{} + {}: {:.0f} pairs tested in place of {:.0f}", featuresRemark(prepared.sceneTree),
                  featuresRemark(prepared.partTree), with.pairsPerQuery(), without.pairsPerQuery());
  return row;
}

SkipRow buildWithoutFeatures(const MeshEntry& entry, const SkipOptions& options) {
  const TriangleMesh mesh = entry.make();
  std::unique_ptr<NormalConeTree> with;
  std::unique_ptr<test::FullHierarchy> without;
  const auto digestOf = [](std::size_t vertices, std::size_t edges, std::size_t faces) {
    return std::uint64_t{vertices} << 42 ^ std::uint64_t{edges} << 21 ^ faces;
  };
  SkipRow row{"features", entry.name, "build", {}, {}, {}};
  RunOptions turns = options.run;
  turns.block = 1;
  turns.warmUp = 0;
  turns.rounds = 1;
  turns.clock = BenchClock::Wall;  // On all processors.
  takeTurns(row, options.repeats,
            {[&](std::size_t) { with = std::make_unique<NormalConeTree>(mesh); },
             [&] {
               const FeatureCounts kept = with->keptFeatures();
               return digestOf(kept.vertices, kept.edges, kept.faces);
             }},
            {[&](std::size_t) { without = std::make_unique<test::FullHierarchy>(mesh); },
             [&] {
               // Those that can carry a minimum.
               const FeatureCounts kept = without->tree().keptFeatures(), idle = without->idle();
               return digestOf(kept.vertices - idle.vertices, kept.edges - idle.edges, kept.faces);
             }},
            turns);
  row.with.bytes = with->byteSize();
  row.without.bytes = without->tree().byteSize();
  row.remark = featuresRemark(*with);
  return row;
}

SkipRow markWithoutDistance(const SceneEntry& entry, const SkipOptions& options) {
  const PreparedScene prepared(entry.make(), kUsualCutoffFraction);
  const std::vector<RigidTransform> path = makePath(prepared, options.path);
  ColdWay with(prepared.sceneTree, prepared.partTree, prepared.cutoff),
      without(prepared.sceneTree, prepared.partTree, prepared.cutoff);
  SkipRow row{"barriers", entry.name, "query and marks", {}, {}, {}};
  takeTurns(row, path.size(),
            {[&](std::size_t i) {
               with.find(path[i]);
               with.mark(path[i], with.distance());
             },
             [&] { return with.digest(); }},
            {[&](std::size_t i) {
               without.find(path[i]);
               without.mark(path[i], 0.0);
             },
             [&] { return without.digest(); }},
            options.run);
  row.remark = "looks along a minimum for what cannot be there as the bodies are apart";
  return row;
}

}  // namespace

std::vector<SkipEntry> querySkips() {
  return {{"features", "Reflex and flat edges and vertices without a polar cone are not in the hierarchy",
           [](const SkipOptions& options) {
             std::vector<SkipRow> rows;
             for (const SceneEntry& entry : chosen(generatedScenes(), kScenes, "scene"))
               rows.push_back(queryWithoutFeatures(entry, options));
             for (const MeshEntry& entry : chosen(generatedMeshes(), kMeshes, "mesh"))
               rows.push_back(buildWithoutFeatures(entry, options));
             return rows;
           }},
          {"barriers", "What may bar the way of a minimum is looked for only where it can be",
           [](const SkipOptions& options) {
             std::vector<SkipRow> rows;
             for (const SceneEntry& entry : chosen(generatedScenes(), kScenes, "scene"))
               rows.push_back(markWithoutDistance(entry, options));
             return rows;
           }}};
}

std::vector<SkipEntry> allSkips() {
  std::vector<SkipEntry> all = querySkips();
  for (const auto& more : {tickSkips(), loadSkips(), frameSkips()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace nearfit::bench
