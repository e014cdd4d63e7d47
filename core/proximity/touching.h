#pragma once

#include <array>

#include <glm/vec3.hpp>

#include "core/math/aabb.h"
#include "core/proximity/minimum.h"

namespace nearfit {

/// What counts as one length, for points and for pieces of flat regions.
class Closeness {
 public:
  /// @param size         Of both bodies together [m].
  /// @param smallerSize  Of the smaller body [m].
  Closeness(double size, double smallerSize) noexcept;

  /// Of two points of the scene that belong to minima whose directions differ.
  double of(const Minimum& a, const Minimum& b) const noexcept;
  /// By how much neighbouring pieces may overlap that only lie in planes which differ a little.
  double ofOverlap(double distance) const noexcept;
  /// How far about an entry its box reaches: boxes of entries that touch or overlap have a point in common.
  double margin(const Minimum& m) const noexcept;

 private:
  double base_, gap_;  ///< [m]
};

/// Whether two entries can be of one set at all: at one distance, and pieces in one plane near each other.
bool canTouch(const Minimum& a, const Minimum& b, const Closeness& closeness) noexcept;

/// Whether entries that can be of one set are: points that are one, pieces with a common point.
bool touch(const Minimum& a, const Minimum& b, const Closeness& closeness) noexcept;

/// The sides of a piece of faces, found once for all that it is held against.
struct PieceSides {
  std::array<glm::dvec3, Minimum::kMaxCorners>
      inward;                                       ///< Unit, in the piece's plane and square to the side.
  std::array<double, Minimum::kMaxCorners> length;  ///< [m]
};
/// @param sides  Of a piece of faces only; left as they are for others.
void findSides(const Minimum& piece, PieceSides& sides) noexcept;

/// An entry and its sides.
struct SidedPiece {
  const Minimum& piece;
  const PieceSides& sides;
};

/// Whether two pieces of one dimension cover more than a line (faces) or a point (edges) together, as those
/// of coplanar faces of one mesh do. They lie in one plane but for tolerances.
bool overlap(const SidedPiece& a, const SidedPiece& b, double tolerance) noexcept;

/// What holds an entry's points on the scene, and `margin` about them [m].
Aabb boxOf(const Minimum& m, double margin) noexcept;

}  // namespace nearfit
