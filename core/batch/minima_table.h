#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/proximity/lmd.h"

namespace nearfit {

/// Minima of a moving part at many poses, column by column. World frame. Rows of pose i are [offsets[i], offsets[i + 1]),
/// nearest first.
struct MinimaTable {
  std::vector<std::int64_t> offsets{0};
  std::vector<std::uint8_t> isComplete;  ///< One for each pose: 0 if there are more than kMaxBatchMinima.

  std::vector<double> distances;                      ///< [m]
  std::vector<glm::dvec3> movingPoints, fixedPoints;  ///< On the moving part, on the other one [m].
  std::vector<glm::dvec3> directions;                 ///< Unit, from the fixed point to the moving one.
  std::vector<std::int32_t> others;                   ///< Index of the other part: PartQueries::otherNames().
  std::vector<std::array<FeatureKind, 2>> features;   ///< What carries the points: fixed, moving.
  std::vector<std::uint8_t> isRegion, isBlocked, isMarginal;  ///< As in Lmd, 0 or 1.

  std::size_t poses() const noexcept { return isComplete.size(); }
  std::size_t rows() const noexcept { return distances.size(); }

  /// Adds a minimum to the pose that is not ended yet.
  /// @param lmd  In the world frame; its scene is the other part.
  void add(const Lmd& lmd, std::int32_t other);
  void endPose(bool isWhole);
};

/// The tables of consecutive poses as one. Leaves them empty.
MinimaTable joined(std::span<MinimaTable> tables);

}  // namespace nearfit
