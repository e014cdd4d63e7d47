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

/// Whether two triangles are surely farther apart than `reach` [m], as the normals and the in-plane normals
/// of their sides tell: far quicker than their distance. False where those do not tell. `reach` should hold
/// some roundings of the coordinates.
bool areSurelyBeyond(const TriangleCorners& a, const TriangleCorners& b, double reach) noexcept;

}  // namespace nearfit
