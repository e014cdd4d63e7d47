#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/cull_kernel.h"

namespace nearfit {

/// A child of each tree, which may hold a minimum together, and where their bounds are.
struct EntryPair {
  std::uint32_t scene, part;                ///< Children, as in NormalConeTree::Node.
  std::uint32_t sceneLane, partLane;        ///< Where their bounds are: kWidth * node + lane.
  float sceneSizeSquared, partSizeSquared;  ///< Squared half diagonals of their boxes [m^2].
};

/// State of a traversal: pairs waiting to be opened, and pairs of leaves reached.
struct TraversalWork {
  /// Max number of waiting pairs at which two are opened at once. Beyond, each leaves at most seven siblings
  /// waiting per level of the two trees, so kRoom is never exceeded.
  static constexpr std::size_t kOpenTwo = 256;
  static constexpr std::size_t kRoom = kOpenTwo + 16 + std::size_t{7} * 2 * NormalConeTree::kMaxDepth + 1;
  static constexpr std::size_t kLeaves = 64;
  static constexpr std::size_t kMaxLeaves = kLeaves + 16;

  std::array<EntryPair, kRoom> waiting;
  std::array<EntryPair, kMaxLeaves> leaves;
  std::size_t waitingCount, leafCount;
  std::uint64_t nodePairs, maxNodePairs;
  const NormalConeTree::Node *scene, *part;
  SinglePose sceneFromPart{RigidTransform{}}, partFromScene{RigidTransform{}};
  CullLimits limits;
  CullSweep inScene, inPart;  ///< The part's sweep in either tree's frame; for swept openers.
};

/// Opens pairs, those nearest the leaves first, until about kLeaves pairs of leaves are found, no pair waits,
/// or maxNodePairs are opened. Never drops a pair of leaves that holds a minimum. Real-time safe.
using Opener = void (*)(TraversalWork& work) noexcept;

/// Returns the opener for an instruction set that the machine has.
Opener opener(SimdLevel level) noexcept;
/// The same for every pose along the sweep; takes about half as long again.
Opener sweptOpener(SimdLevel level) noexcept;
/// Both for contacts: they find only pairs of leaves that can form one (spansContact()), and open no nodes without.
Opener contactOpener(SimdLevel level) noexcept;
Opener sweptContactOpener(SimdLevel level) noexcept;
/// Opener for faces within the cutoff of each other, whatever their directions: finds only pairs of faces,
/// and drops none of those. For surfaces without a side, and to find out if bodies meet.
Opener nearOpener(SimdLevel level) noexcept;

/// Descends two trees together and visits the pairs of leaves that survive the culls. Real-time safe.
class TreeTraversal {
 public:
  /// @param scene, part    Not empty.
  /// @param sceneFromPart  Between the trees' centred frames.
  /// @param work           One per thread; in use until the traversal ends.
  TreeTraversal(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                const CullLimits& limits, Opener open, TraversalWork& work) noexcept
      : open_(open), work_(work) {
    work.scene = scene.nodes().data();
    work.part = part.nodes().data();
    work.sceneFromPart = SinglePose(sceneFromPart);
    work.partFromScene = SinglePose(sceneFromPart.inverse());
    work.limits = limits;
  }

  /// Sets the sweep for a swept opener.
  void setSweep(const CullSweep& inScene, const CullSweep& inPart) noexcept {
    work_.inScene = inScene;
    work_.inPart = inPart;
  }

  /// Calls visit(EntryPair of two leaves) for each surviving pair. Returns false if `maxNodePairs` stops it.
  template <class Visit>
  bool run(Visit&& visit, std::uint64_t maxNodePairs = std::numeric_limits<std::uint64_t>::max()) noexcept {
    const std::uint32_t scene = work_.scene->child[0], part = work_.part->child[0];
    const EntryPair first{scene, part, 0, 0, work_.scene->sizeSquared(0), work_.part->sizeSquared(0)};
    const bool isLeaves = NormalConeTree::isLeaf(scene) && NormalConeTree::isLeaf(part);
    work_.waiting[0] = work_.leaves[0] = first;
    work_.waitingCount = isLeaves ? 0 : 1;
    work_.leafCount = isLeaves ? 1 : 0;
    work_.nodePairs = 0;
    return goOn(visit, maxNodePairs);
  }

  /// Continues after run() returned false, up to `maxNodePairs` in total.
  template <class Visit>
  bool goOn(Visit&& visit, std::uint64_t maxNodePairs) noexcept {
    work_.maxNodePairs = maxNodePairs;
    for (;;) {
      open_(work_);
      for (std::size_t i = 0; i < work_.leafCount; ++i)
        visit(work_.leaves[i]);
      work_.leafCount = 0;
      if (work_.waitingCount == 0) return true;
      if (work_.nodePairs >= work_.maxNodePairs) return false;
    }
  }

  /// Lowers the cutoff [m] from the next batch of leaves on.
  void tighten(float cutoff) noexcept { work_.limits.cutoff = std::min(work_.limits.cutoff, cutoff); }

  /// Counts the work of a visit as this many node pairs.
  void spend(std::uint64_t nodePairs) noexcept { work_.nodePairs += nodePairs; }
  /// Call within a visit: opens no more pairs, as if the bound on the work were reached.
  void stop() noexcept { work_.maxNodePairs = work_.nodePairs; }
  std::uint64_t nodePairs() const noexcept { return work_.nodePairs; }

 private:
  Opener open_;
  TraversalWork& work_;
};

}  // namespace nearfit
