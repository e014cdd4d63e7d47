#include "core/proximity/lmd_query.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <vector>

#include "core/math/tolerances.h"
#include "core/proximity/cull_kernel.h"
#include "core/proximity/leaf_tests.h"
#include "core/proximity/merge_minima.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// A child of each tree that may hold a minimum together, and where its bound stands.
struct EntryPair {
  std::uint32_t scene, part;          ///< Children, as in NormalConeTree::Node.
  std::uint32_t sceneLane, partLane;  ///< 8 * node + lane of their bounds.
  float sceneSize, partSize;
};

struct LmdScratch::Data {
  Data(std::size_t capacity, SimdLevel simd)
      : minima(capacity), order(capacity), parent(capacity), cull(cullKernel(simd)) {}

  /// Each opened node leaves at most seven siblings waiting, and a tree of 2^29 features is at most 12 deep
  /// when median splits share them out; two trees.
  static constexpr std::size_t kMaxStack = 8 * 2 * 16;
  std::array<EntryPair, kMaxStack> stack;
  std::vector<Minimum> minima;
  std::vector<std::uint32_t> order, parent;
  CullKernel cull;
};

LmdScratch::LmdScratch(std::size_t capacity, SimdLevel simd)
    : data_(std::make_unique<Data>(std::max<std::size_t>(capacity, 1), simd)) {}
LmdScratch::~LmdScratch() = default;
LmdScratch::LmdScratch(LmdScratch&&) noexcept = default;
LmdScratch& LmdScratch::operator=(LmdScratch&&) noexcept = default;

namespace {

/// The hierarchy's rounding, and the pose's in single precision, as a fraction of the lengths involved.
constexpr double kPosePadding = 1e-6;

class Traversal {
 public:
  Traversal(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
            double cutoff, LmdScratch::Data& scratch, LmdResult& result) noexcept
      : scene_(scene),
        part_(part),
        tests_(scene, part, sceneFromPart, cutoff),
        sceneFromPart_(SinglePose(sceneFromPart)),
        partFromScene_(SinglePose(sceneFromPart.inverse())),
        scratch_(scratch),
        result_(result) {
    const double reach = scene.size() + part.size() + glm::length(sceneFromPart.translation);
    limits_ = {static_cast<float>(cutoff * (1.0 + kPosePadding)), static_cast<float>(kPosePadding * reach)};
  }

  /// Returns the number of minima found, unmerged.
  std::size_t run() noexcept {
    descend(firstPair());
    while (stackSize_ > 0) {
      const EntryPair pair = scratch_.stack[--stackSize_];
      ++result_.nodePairs;
      const bool opensScene = NormalConeTree::isLeaf(pair.part) ||
                              (!NormalConeTree::isLeaf(pair.scene) && pair.sceneSize >= pair.partSize);
      if (opensScene) {
        openScene(pair);
      } else {
        openPart(pair);
      }
    }
    return found_;
  }

 private:
  EntryPair firstPair() const noexcept {
    return {scene_.nodes()[0].child[0], part_.nodes()[0].child[0], 0, 0,
            scene_.nodes()[0].size(0),  part_.nodes()[0].size(0)};
  }

  static NormalConeTree::Bound boundAt(const NormalConeTree& tree, std::uint32_t lane) noexcept {
    return tree.nodes()[lane / NormalConeTree::kWidth].bound(lane % NormalConeTree::kWidth);
  }

  void openScene(const EntryPair& pair) noexcept {
    const NormalConeTree::Node& node = scene_.nodes()[pair.scene];
    std::uint32_t lanes = scratch_.cull(node, sceneFromPart_.apply(boundAt(part_, pair.partLane)), limits_);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      descend({node.child[lane], pair.part, pair.scene * 8 + lane, pair.partLane, node.size(lane),
               pair.partSize});
    }
  }

  void openPart(const EntryPair& pair) noexcept {
    const NormalConeTree::Node& node = part_.nodes()[pair.part];
    std::uint32_t lanes = scratch_.cull(node, partFromScene_.apply(boundAt(scene_, pair.sceneLane)), limits_);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      descend({pair.scene, node.child[lane], pair.sceneLane, pair.part * 8 + lane, pair.sceneSize,
               node.size(lane)});
    }
  }

  void descend(const EntryPair& pair) noexcept {
    if (NormalConeTree::isLeaf(pair.scene) && NormalConeTree::isLeaf(pair.part)) {
      testLeaves(pair.scene, pair.part);
    } else {
      push(pair);
    }
  }

  void push(const EntryPair& pair) noexcept {
    assert(stackSize_ < scratch_.stack.size());
    scratch_.stack[stackSize_++] = pair;
  }

  void testLeaves(std::uint32_t scene, std::uint32_t part) noexcept {
    ++result_.leafPairs;
    if (found_ < scratch_.minima.size()) {
      if (tests_.test(scene, part, scratch_.minima[found_])) ++found_;
      return;
    }
    Minimum minimum;
    if (!tests_.test(scene, part, minimum)) return;
    // Full: the farthest makes room.
    result_.status = QueryStatus::Truncated;
    const auto isNearer = [](const Minimum& a, const Minimum& b) { return a.lmd.distance < b.lmd.distance; };
    if (!isHeap_) std::make_heap(scratch_.minima.begin(), scratch_.minima.end(), isNearer);
    isHeap_ = true;
    if (minimum.lmd.distance >= scratch_.minima.front().lmd.distance) return;
    std::pop_heap(scratch_.minima.begin(), scratch_.minima.end(), isNearer);
    scratch_.minima.back() = minimum;
    std::push_heap(scratch_.minima.begin(), scratch_.minima.end(), isNearer);
  }

  const NormalConeTree &scene_, &part_;
  LeafTests tests_;
  SinglePose sceneFromPart_, partFromScene_;
  CullLimits limits_;
  LmdScratch::Data& scratch_;
  LmdResult& result_;
  std::size_t stackSize_ = 0, found_ = 0;
  bool isHeap_ = false;
};

}  // namespace

LmdResult findLmds(const NormalConeTree& scene, const NormalConeTree& part,
                   const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                   std::span<Lmd> out) noexcept {
  LmdResult result;
  if (scene.isEmpty() || part.isEmpty() || !(cutoff > 0.0) || !std::isfinite(cutoff) ||
      !sceneFromPart.isFinite()) {
    return result;
  }
  RigidTransform pose = sceneFromPart.normalized();
  pose.translation += pose.rotation * part.centre() - scene.centre();
  LmdScratch::Data& data = scratch.data();
  const std::size_t found = Traversal(scene, part, pose, cutoff, data, result).run();
  const std::size_t kept =
      mergeMinima(std::span(data.minima).first(found), data.order, data.parent, scene.size() + part.size());
  if (kept > out.size()) result.status = QueryStatus::Truncated;
  result.count = std::min(kept, out.size());
  for (std::size_t i = 0; i < result.count; ++i) {
    out[i] = data.minima[data.order[i]].lmd;
    out[i].scenePoint += scene.centre();
    out[i].partPoint += scene.centre();
  }
  return result;
}

}  // namespace nearfit
