#pragma once

#include <glm/vec3.hpp>

#include "core/proximity/query/segment_kernel.h"

namespace nearfit {

class NormalConeTree;

/// Range of a segment that counts, as distances from its start [m].
struct SegmentStretch {
  double from, to;
};

/// A body's surface as an obstacle to segments. Real-time safe.
class SegmentObstacle {
 public:
  /// @param clearance  Distance from a segment's ends and sides within which the surface only touches it [m]; > 0.
  SegmentObstacle(const NormalConeTree& tree, SegmentKernel kernel, double clearance) noexcept
      : tree_(tree), kernel_(kernel), clearance_(clearance) {}

  /// True if the surface passes through the stretch; false for an empty one.
  /// @param start      In the centred frame of the hierarchy [m].
  /// @param direction  Unit.
  /// About one ray cast: O(log n).
  bool blocks(const glm::dvec3& start, const glm::dvec3& direction,
              const SegmentStretch& stretch) const noexcept;

 private:
  SegmentBound boundOf(const glm::dvec3& start, const glm::dvec3& direction,
                       const SegmentStretch& stretch) const noexcept;

  const NormalConeTree& tree_;
  SegmentKernel kernel_;
  double clearance_;
};

/// That distance for two bodies, as a fraction of their sizes. A thousand times the tolerance by which points of
/// minima may lie off their features, far below the resolution of single-precision coordinates (1e-7).
constexpr double kSegmentTouch = 1e-9;

}  // namespace nearfit
