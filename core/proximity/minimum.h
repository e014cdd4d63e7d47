#pragma once

#include <array>
#include <compare>
#include <cstdint>

#include <glm/vec3.hpp>

#include "core/proximity/lmd.h"

namespace nearfit {

/// Result of a leaf test, not yet merged with those of neighbouring features: a point, or a piece of a flat
/// region (a segment or convex polygon of minima that share one distance and direction).
struct Minimum {
  static constexpr std::size_t kMaxCorners = 6;  ///< Two triangles overlap in a hexagon at most.

  Lmd lmd;                     ///< In the scene's centred frame; for a piece, at its centroid.
  bool isOverlapping = false;  ///< Overlaps another piece; set by mergeMinima.
  double radius = 0.0;         ///< Radius of a sphere about scenePoint that holds the piece [m].
  double least = 0.0;          ///< Min distance over the piece [m]; lmd.distance is that at its centroid.
  double weight = 0.0;         ///< Length [m] or area [m^2] of a piece; 0 for a point.
  std::uint8_t dimension = 0;  ///< 0 point, 1 segment, 2 polygon.
  std::uint8_t cornerCount = 0;
  std::array<glm::dvec3, kMaxCorners> corners{};  ///< Corners of a piece, on the scene's side [m].
};

/// Sort key from a minimum's two features; no two entries of a query share one. The order does not depend on
/// when entries were found, hence not on the instruction set or the use of a candidate list.
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
