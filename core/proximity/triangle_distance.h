#pragma once

#include <glm/vec3.hpp>

#include "core/math/triangle_corners.h"

namespace nearfit {

struct ClosestPoints {
  glm::dvec3 a, b;         ///< One on each.
  double distanceSquared;  ///< [m^2]
};

/// Of two segments, which may be points. Accurate to some roundings of their coordinates, nearly parallel
/// ones too. Real-time safe.
ClosestPoints closestOfSegments(const glm::dvec3& a0, const glm::dvec3& a1, const glm::dvec3& b0,
                                const glm::dvec3& b1) noexcept;

/// A triangle with axes of its own: u along its longest side, t across it towards the third corner, n = u x
/// t. What stands square to the longest side is measured without the length along it, so that slivers lose
/// nothing but some roundings of their length.
class TriangleFrame {
 public:
  /// @param corners  Of a triangle with an area; kept by reference.
  explicit TriangleFrame(const TriangleCorners& corners) noexcept;

  struct Coordinates {
    double x, y, z;  ///< Along u, t and n, from the start of the longest side [m].
  };
  Coordinates of(const glm::dvec3& point) const noexcept;
  /// Whether a point over or under the triangle, at x and y, is within its sides.
  /// @param slack  How far beyond them still counts, as a fraction of the longest side.
  bool holds(double x, double y, double slack = 0.0) const noexcept;
  const glm::dvec3& normal() const noexcept { return n_; }

 private:
  glm::dvec3 origin_, u_, t_, n_;
  double length_, height_, apex_;
};

/// Of two triangles with areas; where they pass through each other, a point that both have. Exact but for
/// some roundings of the coordinates, which should be relative to somewhere near. Real-time safe. As good as
/// brute force over all pairs of features: nine pairs of sides, six corners over faces, six sides through
/// faces.
ClosestPoints closestOfTriangles(const TriangleCorners& a, const TriangleCorners& b) noexcept;

/// A triangle's normal and the in-plane normals of its sides: directions along which it may be apart from
/// another. Worth making once for many others. Real-time safe.
class SeparatingDirections {
 public:
  SeparatingDirections() noexcept = default;
  explicit SeparatingDirections(const TriangleCorners& corners) noexcept;

  /// The most that another triangle is apart along one of them, squared [m^2]; 0 where it is along none.
  double squaredGap(const TriangleCorners& other) const noexcept;

 private:
  /// Two numbers at a time, as every machine of 64 bits can.
  using Two = double __attribute__((vector_size(16)));
  /// Two directions of any length, what the square of that is, and how far the triangle reaches along them.
  struct Pair {
    Two x{}, y{}, z{}, lengthSquared{}, low{}, high{};
  };
  static Pair pairOf(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& u,
                     const glm::dvec3& v) noexcept;
  static double squaredGap(const Pair& pair, const TriangleCorners& relative) noexcept;

  glm::dvec3 origin_{0.0};
  Pair first_, second_;
};

/// As gapOfTriangles, with their directions at hand.
struct DirectedTriangle {
  TriangleCorners corners;
  SeparatingDirections directions;
};
double gapOfTriangles(const DirectedTriangle& a, const DirectedTriangle& b, double enough,
                      bool& isSecond) noexcept;

/// A bound below the distance of two triangles [m], as their normals and the in-plane normals of their sides
/// tell: far quicker than that. 0 where those do not tell.
/// @param enough    A bound beyond that is as good as any.
/// @param isSecond  Whether to try the directions of the second triangle first; then, whose tell more.
double gapOfTriangles(const TriangleCorners& a, const TriangleCorners& b, double enough,
                      bool& isSecond) noexcept;

/// Whether two triangles are surely farther apart than `reach` [m], as their gap tells. `reach` should hold
/// some roundings of the coordinates.
inline bool areSurelyBeyond(const TriangleCorners& a, const TriangleCorners& b, double reach) noexcept {
  bool isSecond = false;
  return gapOfTriangles(a, b, reach, isSecond) > reach;
}

}  // namespace nearfit
