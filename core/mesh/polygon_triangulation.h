#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Cuts polygons into triangles with the polygons' own corners and sense, one after the other.
/// Keeps its work space, so that many small polygons cost no allocation.
class PolygonTriangulator {
 public:
  /// Appends the triangles of a polygon to `out`; returns how many. Concave polygons, holes joined to the rim
  /// by bridges (corners that come twice) and corners in a straight line are cut right; corners out of plane
  /// are judged by their shadow along the axis nearest to the normal. One that crosses itself still gives
  /// triangles.
  /// @param points   Coordinates by corner index.
  /// @param polygon  Three corners or more, no two neighbours the same.
  /// Ear cutting: about O(n r), r the number of reflex corners. Throws Error when polygons take too long.
  std::size_t triangulate(std::span<const glm::dvec3> points, std::span<const std::uint32_t> polygon,
                          std::vector<Triangle>& out);

 private:
  struct Corner {
    glm::dvec2 p;
    std::uint32_t index, previous, next;
    bool isBlocker;  ///< Reflex or straight: may lie inside a triangle of others.
  };

  void triangulateQuad(std::span<const glm::dvec3> points, std::span<const std::uint32_t> quad,
                       std::vector<Triangle>& out) const;
  void project(std::span<const glm::dvec3> points, std::span<const std::uint32_t> polygon);
  double turn(std::uint32_t corner) const;
  bool isEar(std::uint32_t corner);
  std::uint32_t findEar(std::uint32_t start, std::size_t left);
  void cut(std::uint32_t corner, std::vector<Triangle>& out);

  std::vector<Corner> corners_;
  std::vector<std::uint32_t> blockers_;
  std::uint64_t tests_ = 0;
};

}  // namespace nearfit
