#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "core/math/tolerances.h"
#include "core/proximity/query/lmd_query.h"
#include "core/proximity/query/query_workspace.h"
#include "core/proximity/query/tree_traversal.h"
#include "tests/bench/decimated_mesh.h"
#include "tests/bench/error_method.h"
#include "tests/bench/float_leaf_tests.h"

namespace nearfit::bench {
namespace {

/// The cold query on other hierarchies than the scene's.
class QueryOnOthers : public ErrorMethod {
 public:
  QueryOnOthers(const ErrorScene& scene, NormalConeTree sceneTree, NormalConeTree partTree)
      : scene_(scene),
        sceneTree_(std::move(sceneTree)),
        partTree_(std::move(partTree)),
        scratch_(kQueryCapacity),
        lmds_(kQueryCapacity) {}

  void answer(const RigidTransform& sceneFromPart, ContactAnswer& answer) override {
    const LmdResult result =
        findLmds(sceneTree_, partTree_, sceneFromPart, scene_.bodies.cutoff, scratch_, lmds_);
    answer.minima.assign(lmds_.begin(), lmds_.begin() + static_cast<std::ptrdiff_t>(result.count));
    answer.wrench = scene_.wrenchOf(answer.minima, sceneFromPart);
  }

 private:
  const ErrorScene& scene_;
  NormalConeTree sceneTree_, partTree_;
  LmdScratch scratch_;
  std::vector<Lmd> lmds_;
};

/// The cold query with leaf tests in single precision; the culls are in single precision anyway.
class FloatLeaves : public ErrorMethod {
 public:
  explicit FloatLeaves(const ErrorScene& scene)
      : scene_(scene),
        sceneBody_(scene.bodies.sceneTree),
        partBody_(scene.bodies.partTree),
        minima_(kQueryCapacity),
        order_(kQueryCapacity),
        merge_(kQueryCapacity),
        open_(opener(defaultSimdLevel())) {}

  void answer(const RigidTransform& sceneFromPart, ContactAnswer& answer) override {
    const std::size_t count = find(sceneFromPart);
    // Tolerances of merging are of double precision: as if the bodies were so much larger.
    constexpr double kScale = FloatLeafTests::kLengthTolerance / kLengthTolerance;
    const double sceneSize = sceneBody_.tree.size(), partSize = partBody_.tree.size();
    const MergeResult merged = mergeMinima(std::span(minima_).first(count), order_, merge_,
                                           kScale * (sceneSize + partSize), std::min(sceneSize, partSize));
    for (std::size_t i = 0; i < merged.count; ++i) {
      Lmd& lmd = answer.minima.emplace_back(minima_[order_[i]].lmd);
      lmd.scenePoint += sceneBody_.tree.centre();
      lmd.partPoint += sceneBody_.tree.centre();
    }
    answer.wrench = scene_.wrenchOf(answer.minima, sceneFromPart);
  }

 private:
  std::size_t find(const RigidTransform& sceneFromPart) {
    const NormalConeTree &sceneTree = sceneBody_.tree, &partTree = partBody_.tree;
    const RigidTransform pose = centredPose(sceneTree, partTree, sceneFromPart);
    const FloatLeafTests tests(sceneBody_, partBody_, pose, scene_.bodies.cutoff);
    TreeTraversal traversal(sceneTree, partTree, pose,
                            cullLimits(sceneTree, partTree, pose, scene_.bodies.cutoff), open_, work_);
    std::size_t count = 0;
    traversal.run([&](const EntryPair& pair) {
      if (count < minima_.size() && tests.test(pair.scene, pair.part, minima_[count])) ++count;
    });
    return count;
  }

  const ErrorScene& scene_;
  FloatBody sceneBody_, partBody_;
  std::vector<Minimum> minima_;
  std::vector<std::uint32_t> order_;
  MergeWork merge_;
  Opener open_;
  TraversalWork work_;
};

ErrorMethodEntry decimated(std::size_t factor) {
  return {
      fmt::format("decimated {}x", factor),
      fmt::format("the exact query on meshes of {} times fewer triangles (quadric error, OpenMesh)", factor),
      1, false, [factor](const ErrorScene& scene) {
        const BenchScene& meshes = scene.bodies.meshes;
        return std::make_unique<QueryOnOthers>(scene, NormalConeTree(decimatedMesh(meshes.scene, factor)),
                                               NormalConeTree(decimatedMesh(meshes.part, factor)));
      }};
}

}  // namespace

std::vector<ErrorMethodEntry> approximateErrorMethods() {
  return {{"normal span", "the rule of Johnson and Willemsen (2003) on hierarchies built for it", 1, false,
           [](const ErrorScene& scene) {
             const BenchScene& meshes = scene.bodies.meshes;
             return std::make_unique<QueryOnOthers>(
                 scene, NormalConeTree(meshes.scene, {}, AcceptanceRule::NormalSpan),
                 NormalConeTree(meshes.part, {}, AcceptanceRule::NormalSpan));
           }},
          {"float leaves", "the exact conditions evaluated in single precision", 1, false,
           [](const ErrorScene& scene) { return std::make_unique<FloatLeaves>(scene); }},
          decimated(4),
          decimated(16)};
}

}  // namespace nearfit::bench
