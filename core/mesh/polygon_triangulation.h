#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Cuts polygons into triangles that keep the polygons' corners and orientation. Reuses its work space, so
/// that many small polygons cause no allocation.
class PolygonTriangulator {
 public:
  /// Appends the triangles of a polygon to `out` and returns their number. Handles concave polygons, holes
  /// joined to the rim by bridges (repeated corners) and collinear corners. Corners out of plane are
  /// projected along the axis nearest to the normal. A self-intersecting polygon still gives triangles.
  /// @param points   Coordinates by corner index.
  /// @param polygon  At least three corners; neighbours differ.
  /// Ear clipping: about O(n r) for r reflex corners. Throws Error if all polygons together take too long.
  std::size_t triangulate(std::span<const glm::dvec3> points, std::span<const std::uint32_t> polygon,
                          std::vector<Triangle>& out);

 private:
  struct Corner {
    glm::dvec2 p;
    std::uint32_t index, previous, next;
    bool isBlocker;  ///< Reflex or straight: may lie inside another corner's triangle.
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
