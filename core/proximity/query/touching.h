#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"
#include "core/proximity/minimum.h"

namespace nearfit {

/// Tolerances by which points and pieces of flat regions count as touching.
class TouchTolerances {
 public:
  /// @param size         Size of both bodies together [m].
  /// @param smallerSize  Size of the smaller body [m].
  TouchTolerances(double size, double smallerSize) noexcept;

  /// Tolerance between scene points of two minima, whose directions may differ [m].
  double of(const Minimum& a, const Minimum& b) const noexcept;
  /// Max overlap of neighbouring pieces that only lie in slightly different planes [m].
  /// @param distance  Distance of their minima [m].
  double ofOverlap(double distance) const noexcept;
  /// Margin of an entry's box [m]: boxes of entries that touch or overlap share a point.
  double margin(const Minimum& m) const noexcept;

 private:
  double base_, gap_;  ///< [m]
};

/// True if two entries may belong to one set: at one distance, and pieces in one plane near each other.
bool canTouch(const Minimum& a, const Minimum& b, const TouchTolerances& closeness) noexcept;

/// True if two entries that may belong to one set do: points that coincide, pieces with a common point.
bool touch(const Minimum& a, const Minimum& b, const TouchTolerances& closeness) noexcept;

/// Sides of a piece of faces, found once for all its comparisons.
struct PieceSides {
  /// Unit, inward, in the piece's plane and perpendicular to the side.
  std::array<glm::dvec3, Minimum::kMaxCorners> inward;
  std::array<double, Minimum::kMaxCorners> length;  ///< [m]
};
/// Finds the sides of a piece of faces; leaves `sides` as it is for other entries.
void findSides(const Minimum& piece, PieceSides& sides) noexcept;

/// An entry and its sides.
struct SidedPiece {
  const Minimum& piece;
  const PieceSides& sides;
};

/// True if two pieces of one dimension share more than a line (faces) or a point (edges), as pieces of
/// coplanar faces of one mesh do. They must lie in one plane within `tolerance` [m].
bool overlap(const SidedPiece& a, const SidedPiece& b, double tolerance) noexcept;

/// Box of an entry's points on the scene, widened by `margin` [m].
Aabb boxOf(const Minimum& m, double margin) noexcept;

}  // namespace nearfit
