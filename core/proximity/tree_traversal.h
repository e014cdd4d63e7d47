#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/proximity/cull_kernel.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// A child of each tree that may hold a minimum together, and where its bound stands.
struct EntryPair {
  std::uint32_t scene, part;                ///< Children, as in NormalConeTree::Node.
  std::uint32_t sceneLane, partLane;        ///< kWidth * node + lane of their bounds.
  float sceneSizeSquared, partSizeSquared;  ///< Of half diagonals [m^2].
};

/// What a traversal has before it: pairs to open, and pairs of leaves that it came to.
struct TraversalWork {
  /// Pairs waiting up to which two are opened at once. Each alone leaves at most seven siblings waiting a
  /// level, of two trees: the room beyond is never used up.
  static constexpr std::size_t kOpenTwo = 256;
  static constexpr std::size_t kRoom = kOpenTwo + 16 + std::size_t{7} * 2 * NormalConeTree::kMaxDepth + 1;
  static constexpr std::size_t kLeaves = 64;
  static constexpr std::size_t kMostLeaves = kLeaves + 16;

  std::array<EntryPair, kRoom> waiting;
  std::array<EntryPair, kMostLeaves> leaves;
  std::size_t waitingCount, leafCount;
  std::uint64_t nodePairs, maxNodePairs;
  const NormalConeTree::Node *scene, *part;
  SinglePose sceneFromPart{RigidTransform{}}, partFromScene{RigidTransform{}};
  CullLimits limits;
  CullSweep inScene, inPart;  ///< A sweep of the part, in either tree's frame; for swept openers.
};

/// Opens pairs, nearest the leaves first, until there are about kLeaves pairs of leaves, nothing is waiting,
/// or maxNodePairs are opened. Never drops a pair of leaves that holds a minimum. Real-time safe.
using Opener = void (*)(TraversalWork& work) noexcept;

/// The opener for a level that the machine has.
Opener opener(SimdLevel level) noexcept;
/// The same for every pose along the sweep: about half as fast again.
Opener sweptOpener(SimdLevel level) noexcept;
/// For what comes within the cutoff of each other, whatever its direction: comes to pairs of faces only, and
/// drops none of those. For surfaces without a side, and to tell whether bodies meet.
Opener nearOpener(SimdLevel level) noexcept;

/// Goes down two trees together and visits the pairs of leaves that survive the culls.
class TreeTraversal {
 public:
  /// @param sceneFromPart  Between the trees' centred frames.
  TreeTraversal(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                const CullLimits& limits, Opener open, TraversalWork& work) noexcept
      : open_(open), work_(work) {
    work.scene = scene.nodes().data();
    work.part = part.nodes().data();
    work.sceneFromPart = SinglePose(sceneFromPart);
    work.partFromScene = SinglePose(sceneFromPart.inverse());
    work.limits = limits;
  }

  /// For a swept opener.
  void setSweep(const CullSweep& inScene, const CullSweep& inPart) noexcept {
    work_.inScene = inScene;
    work_.inPart = inPart;
  }

  /// Calls visit(EntryPair of two leaves) for each; stops after `maxNodePairs` and says false then.
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

  /// Goes on after run() said false, up to so many node pairs in all.
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

  /// From the next batch of leaves on, leaves out what is farther.
  void tighten(float cutoff) noexcept { work_.limits.cutoff = std::min(work_.limits.cutoff, cutoff); }

  /// Lets the work of a visit count as so many pairs of nodes.
  void spend(std::uint64_t nodePairs) noexcept { work_.nodePairs += nodePairs; }
  /// From within a visit: no more is opened, as if the bound of work were reached.
  void stop() noexcept { work_.maxNodePairs = work_.nodePairs; }
  std::uint64_t nodePairs() const noexcept { return work_.nodePairs; }

 private:
  Opener open_;
  TraversalWork& work_;
};

}  // namespace nearfit
