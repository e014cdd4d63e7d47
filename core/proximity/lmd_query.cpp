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
  if (!isDone) result.status = QueryStatus::Truncated;
  collector.finish(scene, part, out);
  return result;
}

}  // namespace nearfit
