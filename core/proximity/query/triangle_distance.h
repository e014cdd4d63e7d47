#pragma once

#include <glm/vec3.hpp>

#include "core/math/triangle_corners.h"

namespace nearfit {

/// Closest points of two shapes.
struct ClosestPoints {
  glm::dvec3 a, b;         ///< A point on each [m].
  double distanceSquared;  ///< [m^2]
};

/// Squared sine of the angle between two segments up to which they are nearly parallel: nearest at an end, to rounding.
constexpr double kParallelSegments = 1e-14;

/// Returns the closest points of two segments, which may be points. Accurate to some roundings of their
/// coordinates, even if nearly parallel. Real-time safe.
ClosestPoints closestOfSegments(const glm::dvec3& a0, const glm::dvec3& a1, const glm::dvec3& b0,
                                const glm::dvec3& b1) noexcept;

/// A triangle with axes of its own: u along its longest side, t in its plane towards the third corner, and n
/// = u x t. What is perpendicular to the longest side is measured without the length along it, so that
/// slivers lose only some roundings of their length. Real-time safe.
class TriangleFrame {
 public:
  /// @param corners  Must have an area.
  explicit TriangleFrame(const TriangleCorners& corners) noexcept;

  struct Coordinates {
    double x, y, z;  ///< Along u, t and n, from the start of the longest side [m].
  };
  /// Coordinates of a point.
  Coordinates of(const glm::dvec3& point) const noexcept;
  /// True if a point above or below the triangle, at x and y, is within its sides.
  /// @param slack  How far beyond them still counts, as a fraction of the longest side.
  bool holds(double x, double y, double slack = 0.0) const noexcept;
  const glm::dvec3& normal() const noexcept { return n_; }

 private:
  glm::dvec3 origin_, u_, t_, n_;
  double length_, height_, apex_;
};

/// Returns the closest points of two triangles with areas; a common point if they pass through each other.
/// Exact but for some roundings of the coordinates, which should be relative to a point nearby. Real-time
/// safe. As good as brute force over all pairs of features: nine pairs of sides, six corners over faces, six
/// sides through faces.
ClosestPoints closestOfTriangles(const TriangleCorners& a, const TriangleCorners& b) noexcept;

/// A triangle's normal and the in-plane normals of its sides: directions along which another triangle may be
/// apart from it. Worth building once to test against many others. Real-time safe.
class SeparatingDirections {
 public:
  SeparatingDirections() noexcept = default;
  explicit SeparatingDirections(const TriangleCorners& corners) noexcept;

  /// Max squared gap to another triangle along one of the directions [m^2]; 0 if none separates them.
  double squaredGap(const TriangleCorners& other) const noexcept;
  /// The direction of that gap, unit, towards the other; zero if there is none.
  glm::dvec3 directionOfGap(const TriangleCorners& other) const noexcept;

 private:
  /// Two numbers at a time, as every 64-bit machine supports.
  using Two = double __attribute__((vector_size(16)));
  /// Two directions of any length, their squared lengths, and the triangle's extents along them.
  struct Pair {
    Two x{}, y{}, z{}, lengthSquared{}, low{}, high{};
  };
  static Pair pairOf(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& u,
                     const glm::dvec3& v) noexcept;
  static double squaredGap(const Pair& pair, const TriangleCorners& relative) noexcept;

  glm::dvec3 origin_{0.0};
  Pair first_, second_;
};

/// A triangle and its directions, for triangleGapLowerBound.
struct DirectedTriangle {
  TriangleCorners corners;
  SeparatingDirections directions;
};
/// The same lower bound as the overload below, along the given directions.
double triangleGapLowerBound(const DirectedTriangle& a, const DirectedTriangle& b, double enough,
                             bool& isSecond) noexcept;

/// Returns a lower bound on the distance of two triangles [m], from their normals and the in-plane normals of
/// their sides: much quicker than the distance, and 0 if none of these separates them. Real-time safe.
/// @param enough    A bound beyond this [m] is as good as any.
/// @param isSecond  In: try the directions of the second triangle first. Out: whose directions gave more.
double triangleGapLowerBound(const TriangleCorners& a, const TriangleCorners& b, double enough,
                             bool& isSecond) noexcept;

/// Direction of that bound, unit, from the first triangle to the second; zero if it is 0.
/// @param isSecond  As it came out.
glm::dvec3 directionOfGap(const DirectedTriangle& a, const DirectedTriangle& b, bool isSecond) noexcept;
glm::dvec3 directionOfGap(const TriangleCorners& a, const TriangleCorners& b, bool isSecond) noexcept;

/// True if two triangles are surely farther apart than `reach` [m], by their gap. `reach` should include some
/// roundings of the coordinates.
inline bool areSurelyBeyond(const TriangleCorners& a, const TriangleCorners& b, double reach) noexcept {
  bool isSecond = false;
  return triangleGapLowerBound(a, b, reach, isSecond) > reach;
}

}  // namespace nearfit
