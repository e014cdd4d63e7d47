#pragma once

#include <cstdint>
#include <limits>

#include <glm/vec3.hpp>

#include "core/proximity/overlap/placed_mesh.h"

namespace nearfit {

/// The point of a surface nearest to a given one.
struct NearestPoint {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  double distance = std::numeric_limits<double>::infinity();  ///< [m]
  glm::dvec3 point{0.0};                                      ///< In the mesh's frame [m].
  std::uint32_t triangle = kNone;                             ///< Of the hierarchy's mesh.

  bool isFound() const noexcept { return triangle != kNone; }
};

/// Finds the point of a mesh nearest to another one, regardless of the sides of its surface: the boxes of the
/// hierarchy bound the distance, and what is left is computed in double precision, to some roundings of the
/// coordinates. Thread-safe.
class PointDistance {
 public:
  /// @param mesh  In its own frame: not placed. Kept by reference. Its loose triangles count too; each point is
  ///              compared with all of those.
  explicit PointDistance(const PlacedMesh& mesh) : mesh_(mesh) {}

  /// Returns the nearest point, or none if it is not nearer than `within`. Of several equally near ones it may return
  /// any, the same for the same arguments. Real-time safe: no allocation, lock or throw. O(log n) where the surface is
  /// near.
  /// @param point   In the mesh's frame [m].
  /// @param within  May be infinite [m].
  /// @param start   A triangle that is probably near, such as that found for the point before; kNone if unknown.
  NearestPoint nearest(const glm::dvec3& point, double within,
                       std::uint32_t start = NearestPoint::kNone) const noexcept;

 private:
  const PlacedMesh& mesh_;
};

/// Nearest point of a triangle, which may have no area. Real-time safe.
NearestPoint nearestOnCorners(const TriangleCorners& corners, const glm::dvec3& point) noexcept;

}  // namespace nearfit
