#include "core/proximity/query/blocked_minima.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/query_workspace.h"
#include "core/proximity/query/segment_passage.h"

namespace nearfit {
namespace {

/// Distance from a segment's ends and sides within which a surface only touches it, as a fraction of the
/// sizes of the bodies. A thousand times the tolerance by which points of minima may lie off their features,
/// far below the resolution of single-precision coordinates (1e-7).
constexpr double kTouch = 1e-9;

/// Rounding of a segment to single precision, as a fraction of the lengths involved: some ten roundings.
constexpr double kSinglePadding = 1e-6;

/// Range of a segment that counts, as distances from its start [m].
struct Stretch {
  double from, to;
};

/// One body, tested for surfaces across a segment in the frame of its hierarchy.
class Obstacle {
 public:
  Obstacle(const NormalConeTree& tree, SegmentKernel kernel, double clearance) noexcept
      : tree_(tree), kernel_(kernel), clearance_(clearance) {}

  bool blocks(const glm::dvec3& start, const glm::dvec3& direction, const Stretch& stretch) const noexcept {
    if (!(stretch.from < stretch.to)) return false;
    const SegmentBound bound = boundOf(start, direction, stretch);
    SegmentPassage passage(start, direction, stretch.from, stretch.to, clearance_);
    // At most seven siblings wait per level of the tree.
    std::array<std::uint32_t, 7 * 12 + 1> stack;
    std::size_t size = 0;
    // The root has one child, which holds everything; it is a leaf in a tree of a single feature.
    const std::uint32_t top = tree_.nodes()[0].child[0];
    stack[size++] = NormalConeTree::isLeaf(top) ? 0 : top;
    while (size > 0) {
      const NormalConeTree::Node& node = tree_.nodes()[stack[--size]];
      for (std::uint32_t lanes = kernel_(node, bound); lanes != 0; lanes &= lanes - 1) {
        const std::uint32_t child = node.child[static_cast<std::size_t>(std::countr_zero(lanes))];
        if (!NormalConeTree::isLeaf(child)) {
          stack[size++] = child;
        } else if (NormalConeTree::leafKind(child) == FeatureKind::Face) {
          addFace(NormalConeTree::leafIndex(child), passage);
          if (passage.isClosed()) return true;
        }
      }
    }
    return false;
  }

 private:
  SegmentBound boundOf(const glm::dvec3& start, const glm::dvec3& direction,
                       const Stretch& stretch) const noexcept {
    const glm::dvec3 middle = start + 0.5 * (stretch.from + stretch.to) * direction;
    const double halfLength = 0.5 * (stretch.to - stretch.from);
    SegmentBound bound;
    for (glm::length_t i = 0; i < 3; ++i) {
      bound.middle[static_cast<std::size_t>(i)] = static_cast<float>(middle[i]);
      bound.half[static_cast<std::size_t>(i)] = static_cast<float>(halfLength * direction[i]);
    }
    const double reach = tree_.size() + glm::length(middle) + halfLength;
    bound.padding = static_cast<float>(kSinglePadding * reach + clearance_);
    return bound;
  }

  void addFace(std::uint32_t face, SegmentPassage& passage) const noexcept {
    const Triangle& t = tree_.faces()[face].corners;
    passage.add(tree_.positions()[t[0]], tree_.positions()[t[1]], tree_.positions()[t[2]]);
  }

  const NormalConeTree& tree_;
  SegmentKernel kernel_;
  double clearance_;
};

}  // namespace

void markBlocked(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& sceneFromPart,
                 std::span<Lmd> lmds, double leastDistance, LmdScratch& scratch) noexcept {
  if (scene.isEmpty() || part.isEmpty() || !sceneFromPart.isFinite()) return;
  const double touch = kTouch * (scene.size() + part.size());
  const SegmentKernel kernel = scratch.data().segmentCull;
  const Obstacle sceneObstacle(scene, kernel, touch), partObstacle(part, kernel, touch);
  const RigidTransform partFromScene = centredPose(scene, part, sceneFromPart).inverse();
  for (Lmd& lmd : lmds) {
    const glm::dvec3 start = scenePointInside(lmd) - scene.centre();
    // Away from its centroid, a region that is not quite flat lies slightly off the segment's ends.
    const double off = kFlatTolerance * (2.0 * lmd.extent.halfLength + glm::length(lmd.extent.inside));
    const Stretch open{touch + off, lmd.distance - touch - off};
    // If the segment crosses the scene, the rest of it joins the scene to its end on the part, and is no
    // shorter than the least distance. The same holds for the part, seen from the other end. So the nearest
    // minimum of bodies that do not interpenetrate is never blocked, and those not much
    // longer need few tests.
    const Stretch byScene{open.from, std::min(open.to, lmd.distance - leastDistance + touch + off)};
    const Stretch byPart{std::max(open.from, leastDistance - touch - off), open.to};
    lmd.isBlocked = sceneObstacle.blocks(start, lmd.direction, byScene) ||
                    partObstacle.blocks(partFromScene.applyToPoint(start),
                                        partFromScene.applyToVector(lmd.direction), byPart);
  }
}

}  // namespace nearfit
