#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Number of a flat that stands for none.
constexpr std::uint32_t kNoFlat = std::numeric_limits<std::uint32_t>::max();

/// Plane of a flat: the points p with dot(normal, p - origin) = 0. The normal is unit and points outward.
struct FlatPlane {
  glm::dvec3 origin{0.0}, normal{0.0};
  double height(const glm::dvec3& p) const noexcept {
    const glm::dvec3 w = p - origin;
    return normal.x * w.x + normal.y * w.y + normal.z * w.z;
  }
};

/// A triangle lower than this many tolerances, over its longest side, has no reliable normal. That of a higher one is
/// off by less than two tolerances over its height, a quarter of a radian.
constexpr double kReliableHeight = 8.0;

/// Returns the max distance of a flat's corners from its plane that the rounding of coordinates explains [m]; 0 for a
/// mesh without points.
/// @param coordinateRounding  Max rounding error of a coordinate of the mesh [m]; >= 0.
double flatTolerance(const TriangleMesh& mesh, double coordinateRounding);

/// The flats of a mesh: sets of at least two triangles, connected through ordinary edges, whose corners all lie
/// within a tolerance of one plane and that face the same side of it.
struct FlatGroups {
  std::vector<std::uint32_t> flatOf;  ///< By triangle: its flat, or kNoFlat.
  std::vector<FlatPlane> planes;      ///< By flat.
};

/// Finds the flats of a mesh, large triangles first. About O(n log n); allocates.
/// @param tolerance   Max distance of a corner from its flat's plane [m]; > 0.
/// @param onProgress  Called now and then with the fraction done; may throw to stop the work. May be empty.
FlatGroups findFlats(const TriangleMesh& mesh, double tolerance,
                     const std::function<void(double fraction)>& onProgress = {});

}  // namespace nearfit
