#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "core/proximity/cull_kernel.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// A child of each tree that may hold a minimum together, and where its bound stands.
struct EntryPair {
  std::uint32_t scene, part;          ///< Children, as in NormalConeTree::Node.
  std::uint32_t sceneLane, partLane;  ///< kWidth * node + lane of their bounds.
  float sceneSize, partSize;
};

/// Each opened node leaves at most seven siblings waiting; two trees.
using TraversalStack = std::array<EntryPair, 7 * 2 * NormalConeTree::kMaxDepth + 1>;

/// Goes down two trees together and visits the pairs of leaves that survive the culls.
class TreeTraversal {
 public:
  /// @param sceneFromPart  Between the trees' centred frames.
  TreeTraversal(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                const CullLimits& limits, CullKernel cull, TraversalStack& stack) noexcept
      : scene_(scene),
        part_(part),
        sceneFromPart_(sceneFromPart),
        partFromScene_(sceneFromPart.inverse()),
        limits_(limits),
        cull_(cull),
        stack_(stack) {}

  /// Calls visit(EntryPair of two leaves) for each; stops after `maxNodePairs` and says false then.
  template <class Visit>
  bool run(Visit&& visit, std::uint64_t maxNodePairs = std::numeric_limits<std::uint64_t>::max()) noexcept {
    const NormalConeTree::Node &sceneRoot = scene_.nodes()[0], &partRoot = part_.nodes()[0];
    descend({sceneRoot.child[0], partRoot.child[0], 0, 0, sceneRoot.size(0), partRoot.size(0)}, visit);
    while (size_ > 0) {
      if (nodePairs_ == maxNodePairs) return false;
      ++nodePairs_;
      const EntryPair pair = stack_[--size_];
      const bool opensScene = NormalConeTree::isLeaf(pair.part) ||
                              (!NormalConeTree::isLeaf(pair.scene) && pair.sceneSize >= pair.partSize);
      if (opensScene) {
        openScene(pair, visit);
      } else {
        openPart(pair, visit);
      }
    }
    return true;
  }

  std::uint64_t nodePairs() const noexcept { return nodePairs_; }

 private:
  static constexpr auto kWidth = static_cast<std::uint32_t>(NormalConeTree::kWidth);

  static NormalConeTree::Bound boundAt(const NormalConeTree& tree, std::uint32_t lane) noexcept {
    return tree.nodes()[lane / kWidth].bound(lane % kWidth);
  }

  template <class Visit>
  void openScene(const EntryPair& pair, Visit& visit) noexcept {
    const NormalConeTree::Node& node = scene_.nodes()[pair.scene];
    std::uint32_t lanes = cull_(node, sceneFromPart_.apply(boundAt(part_, pair.partLane)), limits_);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      descend({node.child[lane], pair.part, pair.scene * kWidth + lane, pair.partLane, node.size(lane),
               pair.partSize},
              visit);
    }
  }

  template <class Visit>
  void openPart(const EntryPair& pair, Visit& visit) noexcept {
    const NormalConeTree::Node& node = part_.nodes()[pair.part];
    std::uint32_t lanes = cull_(node, partFromScene_.apply(boundAt(scene_, pair.sceneLane)), limits_);
    for (; lanes != 0; lanes &= lanes - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
      descend({pair.scene, node.child[lane], pair.sceneLane, pair.part * kWidth + lane, pair.sceneSize,
               node.size(lane)},
              visit);
    }
  }

  template <class Visit>
  void descend(const EntryPair& pair, Visit& visit) noexcept {
    if (NormalConeTree::isLeaf(pair.scene) && NormalConeTree::isLeaf(pair.part)) {
      visit(pair);
    } else {
      stack_[size_++] = pair;
    }
  }

  const NormalConeTree &scene_, &part_;
  const SinglePose sceneFromPart_, partFromScene_;
  const CullLimits limits_;
  const CullKernel cull_;
  TraversalStack& stack_;
  std::size_t size_ = 0;
  std::uint64_t nodePairs_ = 0;
};

}  // namespace nearfit
