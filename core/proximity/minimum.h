#pragma once

#include <array>
#include <compare>
#include <cstdint>

#include <glm/vec3.hpp>

#include "core/proximity/lmd.h"

namespace nearfit {

/// What the leaf tests find before neighbours that claim the same minimum are merged: a point of minima, or a
/// piece of a flat region (a segment or a convex polygon of them, all at one distance and direction).
struct Minimum {
  static constexpr std::size_t kMaxCorners = 6;  ///< Two triangles overlap in a hexagon at most.

  Lmd lmd;                     ///< In the query's frame; for a piece, its centroid.
  bool isOverlapping = false;  ///< With another piece: see markIfOverlapping.
  double radius = 0.0;         ///< Of a sphere about scenePoint that holds a piece [m].
  double least = 0.0;          ///< Distance where a piece is nearest; at its centroid it is lmd.distance [m].
  double weight = 0.0;         ///< Length or area of a piece; 0 for a point.
  std::uint8_t dimension = 0;  ///< 0 point, 1 segment, 2 polygon.
  std::uint8_t cornerCount = 0;
  std::array<glm::dvec3, kMaxCorners> corners{};  ///< Of a piece, scene side.
};

/// The two features of a minimum, as numbers: no two entries of a query have the same. Their order does not
/// depend on when entries were found, and so not on the instruction set or a candidate list.
struct FeatureKey {
  std::uint64_t scene, part;
  auto operator<=>(const FeatureKey&) const = default;
};

inline FeatureKey featureKey(const Minimum& m) noexcept {
  const auto packed = [](FeatureKind kind, std::uint32_t index) {
    return static_cast<std::uint64_t>(kind) << 32 | index;
  };
  return {packed(m.lmd.sceneFeature, m.lmd.sceneIndex), packed(m.lmd.partFeature, m.lmd.partIndex)};
}

}  // namespace nearfit
