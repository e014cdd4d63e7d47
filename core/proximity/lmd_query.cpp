#include "core/proximity/lmd_query.h"

#include <algorithm>

#include "core/proximity/leaf_tests.h"
#include "core/proximity/query_workspace.h"

namespace nearfit {

LmdScratch::LmdScratch(std::size_t capacity, SimdLevel simd)
    : data_(std::make_unique<Data>(std::max<std::size_t>(capacity, 1), simd)) {}
LmdScratch::~LmdScratch() = default;
LmdScratch::LmdScratch(LmdScratch&&) noexcept = default;
LmdScratch& LmdScratch::operator=(LmdScratch&&) noexcept = default;

LmdResult findLmds(const NormalConeTree& scene, const NormalConeTree& part,
                   const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                   std::span<Lmd> out, std::uint64_t maxNodePairs) noexcept {
  LmdResult result;
  result.completeTo = cutoff;
  if (!isQueryValid(scene, part, sceneFromPart, cutoff)) return result;
  const RigidTransform pose = centredPose(scene, part, sceneFromPart);
  LmdScratch::Data& workspace = scratch.data();
  const LeafTests tests(scene, part, pose, cutoff);
  MinimaCollector collector(workspace, result);
  TreeTraversal traversal(scene, part, pose, cullLimits(scene, part, pose, cutoff), workspace.open,
                          workspace.traversal);
  const bool isDone = traversal.run(
      [&](const EntryPair& pair) {
        ++result.leafPairs;
        if (tests.test(pair.scene, pair.part, collector.slot())) collector.add();
      },
      maxNodePairs);
  result.nodePairs = traversal.nodePairs();
  if (!isDone) {
    result.status = QueryStatus::Truncated;
    result.completeTo = 0.0;
  }
  collector.finish(scene, part, out);
  return result;
}

LmdResult findNearestLmds(const NormalConeTree& scene, const NormalConeTree& part,
                          const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                          std::span<Lmd> out, std::uint64_t maxNodePairs) noexcept {
  // The first try gets half of the work, and each next one half of what is left, at a quarter of the radius:
  // what lies within a radius falls faster than that.
  constexpr int kTries = 4;
  constexpr double kRadiusRatio = 0.25;
  std::uint64_t left = maxNodePairs, nodePairs = 0, leafPairs = 0;
  LmdResult result;
  double radius = cutoff;
  for (int i = 1; i <= kTries; ++i, radius *= kRadiusRatio) {
    result = findLmds(scene, part, sceneFromPart, radius, scratch, out, i == kTries ? left : left / 2);
    left -= std::min(left, result.nodePairs);
    result.nodePairs = nodePairs += result.nodePairs;
    result.leafPairs = leafPairs += result.leafPairs;
    if (result.completeTo > 0.0) break;
  }
  if (result.completeTo < cutoff) result.status = QueryStatus::Truncated;
  return result;
}

}  // namespace nearfit
