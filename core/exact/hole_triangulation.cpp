#include "core/exact/hole_triangulation.h"

#include <exception>
#include <iterator>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>

namespace nearfit {
namespace {

/// Up to this many corners all triangulations are compared where the one by Delaunay's fails, in cubic time: a
/// hundredth of a second.
constexpr std::size_t kMaxCubicCorners = 100;

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulateHole(std::span<const glm::dvec3> corners) {
  if (corners.size() < 3 || corners.size() > kMaxHoleCorners) return {};
  if (corners.size() == 3) return {{0, 1, 2}};
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_3> polygon;
  polygon.reserve(corners.size());
  for (const glm::dvec3& p : corners)
    polygon.emplace_back(p.x, p.y, p.z);
  std::vector<CGAL::Triple<int, int, int>> filled;
  try {
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(
        polygon, std::back_inserter(filled),
        CGAL::parameters::use_delaunay_triangulation(true).do_not_use_cubic_algorithm(corners.size() >
                                                                                      kMaxCubicCorners));
  } catch (const std::exception&) {
    return {};  // Its checks of conditions, which points almost in one place do not meet.
  }
  if (filled.size() != corners.size() - 2) return {};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(filled.size());
  for (const auto& t : filled)
    triangles.push_back({static_cast<std::uint32_t>(t.first), static_cast<std::uint32_t>(t.second),
                         static_cast<std::uint32_t>(t.third)});
  return triangles;
}

}  // namespace nearfit
