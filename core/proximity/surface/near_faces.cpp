#include "core/proximity/surface/near_faces.h"

#include <array>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"

namespace nearfit {
namespace {

/// PlacedBox of a child in some frame.
struct PlacedBox {
  glm::dvec3 centre;
  std::array<glm::dvec3, 3> axes;
  std::array<double, 3> half;
};

glm::dvec3 toDouble(const std::array<float, 3>& v) noexcept {
  return {v[0], v[1], v[2]};
}

PlacedBox placedBoxOf(const NormalConeTree& tree, std::uint32_t lane, const RigidTransform& pose) noexcept {
  const NormalConeTree::Bound b =
      tree.nodes()[lane / NormalConeTree::kWidth].bound(lane % NormalConeTree::kWidth);
  return {pose.applyToPoint(toDouble(b.centre)),
          {pose.applyToVector(toDouble(b.n)), pose.applyToVector(toDouble(b.u)),
           pose.applyToVector(toDouble(b.v))},
          {b.half[0], b.half[1], b.half[2]}};
}

/// Lower bound on the distance between two boxes, along the axes of `box` [m].
double gapAlong(const PlacedBox& box, const PlacedBox& other) noexcept {
  double squared = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    double reach = box.half[k];
    for (std::size_t i = 0; i < 3; ++i)
      reach += other.half[i] * std::abs(glm::dot(box.axes[k], other.axes[i]));
    const double beyond = std::abs(glm::dot(other.centre - box.centre, box.axes[k])) - reach;
    squared += beyond > 0.0 ? beyond * beyond : 0.0;
  }
  return std::sqrt(squared);
}

}  // namespace

double NearFaces::leastNotVisited() const noexcept {
  const TraversalWork& work = workspace_.traversal;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < work.waitingCount; ++i) {
    const EntryPair& pair = work.waiting[i];
    const PlacedBox scene = placedBoxOf(scene_, pair.sceneLane, {}),
                    part = placedBoxOf(part_, pair.partLane, placed_.pose());
    least = std::min(least, std::max(gapAlong(scene, part), gapAlong(part, scene)));
  }
  // Single-precision axes are unit to within a few roundings.
  constexpr double kAxes = 1.0 - 1e-6;
  return std::max(0.0, kAxes * least - limits_.padding);
}

double PlacedFaces::rounding() const noexcept {
  const double reach = scene_.size() + part_.size();
  return kLengthTolerance * reach + kPointRounding * glm::length(pose_.translation);
}

}  // namespace nearfit
