#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "core/math/triangle_corners.h"

/// Tests in double precision that spare exact arithmetic for most pairs of triangles of one mesh.
namespace nearfit {

/// Puts the corners that two triangles share first in both, in the same order; returns their number.
inline std::size_t alignSharedCorners(std::array<std::uint32_t, 3>& a, std::array<std::uint32_t, 3>& b) {
  std::size_t shared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto same = std::find(b.begin() + static_cast<std::ptrdiff_t>(shared), b.end(), a[i]);
    if (same == b.end()) continue;
    std::iter_swap(same, b.begin() + static_cast<std::ptrdiff_t>(shared));
    std::swap(a[i], a[shared]);
    ++shared;
  }
  return shared;
}

/// Rounding of the dot product of two vectors, each off by some roundings, over the product of their lengths.
constexpr double kDotRounding = 1e-14;

inline bool isClearlyPositive(const glm::dvec3& axis, const glm::dvec3& v) {
  return glm::dot(axis, v) > kDotRounding * glm::length(axis) * glm::length(v);
}

inline bool areClearlyApartAlong(const glm::dvec3& axis, const TriangleCorners& a, const TriangleCorners& b) {
  const auto isBeyond = [&axis](const TriangleCorners& low, const TriangleCorners& high) {
    return std::ranges::all_of(low, [&](const glm::dvec3& p) {
      return std::ranges::all_of(high, [&](const glm::dvec3& q) { return isClearlyPositive(axis, q - p); });
    });
  };
  return isBeyond(a, b) || isBeyond(b, a);
}

/// True if the plane of a, or a plane through one of its sides and perpendicular to it, separates the two.
inline bool areClearlyApartBeside(const TriangleCorners& a, const TriangleCorners& b) {
  const glm::dvec3 normal = glm::cross(a[1] - a[0], a[2] - a[0]);
  if (areClearlyApartAlong(normal, a, b)) return true;
  for (std::size_t k = 0; k < 3; ++k) {
    if (areClearlyApartAlong(glm::cross(a[(k + 1) % 3] - a[k], normal), a, b)) return true;
  }
  return false;
}

/// True if a plane through their common corner, the first of each, has one on either side.
inline bool areClearlyApartAtCorner(const TriangleCorners& a, const TriangleCorners& b) {
  const auto unit = [](const glm::dvec3& v) {
    return v / std::max(glm::length(v), std::numeric_limits<double>::min());
  };
  const glm::dvec3 a1 = a[1] - a[0], a2 = a[2] - a[0], b1 = b[1] - a[0], b2 = b[2] - a[0];
  const glm::dvec3 axis = unit(a1) + unit(a2) - unit(b1) - unit(b2);
  return isClearlyPositive(axis, a1) && isClearlyPositive(axis, a2) && isClearlyPositive(axis, -b1) &&
         isClearlyPositive(axis, -b2);
}

/// True if they lie on either side of their common side, the first of each, so that they are not folded onto each
/// other.
inline bool areClearlyApartAtSide(const TriangleCorners& a, const TriangleCorners& b) {
  const glm::dvec3 side = a[1] - a[0], normalA = glm::cross(side, a[2] - a[0]),
                   normalB = glm::cross(b[2] - b[0], side);
  const double scale = glm::dot(side, side) * glm::length(a[2] - a[0]) * glm::length(b[2] - b[0]);
  return glm::dot(normalA, normalB) > kDotRounding * scale;
}

/// True if double precision shows that two triangles of a mesh have no more in common than their shared corners and, if
/// they share two, the side between them.
/// @param shared  Number of shared corners, which come first in both; see alignSharedCorners().
inline bool areClearlyApart(const TriangleCorners& a, const TriangleCorners& b, std::size_t shared) {
  switch (shared) {
    case 0:
      return areClearlyApartBeside(a, b) || areClearlyApartBeside(b, a);
    case 1:
      return areClearlyApartAtCorner(a, b);
    case 2:
      return areClearlyApartAtSide(a, b);
    default:
      return false;
  }
}

}  // namespace nearfit
