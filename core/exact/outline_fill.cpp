#include "core/exact/outline_fill.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

namespace nearfit {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<std::uint32_t, Kernel>;
/// Each face stores the region that it belongs to; -1 for none yet.
using FaceBase =
    CGAL::Triangulation_face_base_with_info_2<int, Kernel,
                                              CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>, CGAL::Exact_predicates_tag>;
using Segment = std::array<std::uint32_t, 2>;

constexpr std::uint32_t kUnnumbered = std::numeric_limits<std::uint32_t>::max();

/// Winding and crossing numbers of points with respect to an outline, from a ray to the right.
class Winding {
 public:
  Winding(std::span<const glm::dvec2> points, std::span<const Segment> segments)
      : points_(points), segments_(segments) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const Segment& s : segments) {
      least = std::min({least, points[s[0]].y, points[s[1]].y});
      most = std::max({most, points[s[0]].y, points[s[1]].y});
    }
    least_ = least;
    strips_.resize(std::clamp<std::size_t>(segments.size() / 4, 1, kMaxStrips));
    perMetre_ = most > least ? static_cast<double>(strips_.size()) / (most - least) : 0.0;
    for (std::uint32_t i = 0; i < segments.size(); ++i) {
      const auto [low, high] =
          std::minmax({stripOf(points[segments[i][0]].y), stripOf(points[segments[i][1]].y)});
      for (std::size_t strip = low; strip <= high; ++strip)
        strips_[strip].push_back(i);
    }
  }

  struct Count {
    int wound = 0;    ///< Winding number, anticlockwise.
    int crossed = 0;  ///< Segments crossed.
  };
  Count around(const glm::dvec2& p) const {
    Count count;
    for (const std::uint32_t i : strips_[stripOf(p.y)]) {
      const glm::dvec2 a = points_[segments_[i][0]], b = points_[segments_[i][1]];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      const double x = a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
      if (!(x > p.x)) continue;
      count.wound += b.y > a.y ? 1 : -1;
      ++count.crossed;
    }
    return count;
  }

 private:
  static constexpr std::size_t kMaxStrips = 4096;
  std::size_t stripOf(double y) const {
    const double strip = (y - least_) * perMetre_;
    return strip > 0.0 ? std::min(static_cast<std::size_t>(strip), strips_.size() - 1) : 0;
  }

  std::span<const glm::dvec2> points_;
  std::span<const Segment> segments_;
  double least_ = 0.0, perMetre_ = 0.0;
  std::vector<std::vector<std::uint32_t>> strips_;  ///< Segments in each horizontal strip.
};

glm::dvec2 pointOf(const Triangulation::Vertex_handle& vertex) {
  return {vertex->point().x(), vertex->point().y()};
}

double doubleArea(const Triangulation::Face_handle& face) {
  const glm::dvec2 a = pointOf(face->vertex(0)), b = pointOf(face->vertex(1)), c = pointOf(face->vertex(2));
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Marks all faces reachable from `first` without crossing a constraint as `region`; returns the largest.
Triangulation::Face_handle gather(const Triangulation& triangulation, Triangulation::Face_handle first,
                                  int region) {
  std::vector<Triangulation::Face_handle> open{first};
  first->info() = region;
  Triangulation::Face_handle largest = first;
  while (!open.empty()) {
    const Triangulation::Face_handle face = open.back();
    open.pop_back();
    if (doubleArea(face) > doubleArea(largest)) largest = face;
    for (int side = 0; side < 3; ++side) {
      const Triangulation::Face_handle next = face->neighbor(side);
      if (triangulation.is_infinite(next) || next->info() >= 0 || face->is_constrained(side)) continue;
      next->info() = region;
      open.push_back(next);
    }
  }
  return largest;
}

}  // namespace

FilledOutline fillOutline(std::span<const glm::dvec2> points, std::span<const Segment> segments,
                          FillRule rule) {
  std::vector<Kernel::Point_2> corners;
  corners.reserve(points.size());
  for (const glm::dvec2& p : points)
    corners.emplace_back(p.x, p.y);
  std::vector<std::pair<std::size_t, std::size_t>> constraints;
  for (const Segment& s : segments) {
    if (points[s[0]] != points[s[1]]) constraints.emplace_back(s[0], s[1]);
  }
  Triangulation triangulation;
  triangulation.insert_constraints(corners.begin(), corners.end(), constraints.begin(), constraints.end());
  FilledOutline filled;
  if (triangulation.dimension() < 2) return filled;
  for (const auto& face : triangulation.all_face_handles())
    face->info() = -1;
  for (const auto& vertex : triangulation.finite_vertex_handles())
    vertex->info() = kUnnumbered;

  const Winding winding(points, segments);
  std::vector<bool> isInside;
  for (const auto& face : triangulation.finite_face_handles()) {
    if (face->info() < 0) {
      const Triangulation::Face_handle largest =
          gather(triangulation, face, static_cast<int>(isInside.size()));
      const Winding::Count count = winding.around(
          (pointOf(largest->vertex(0)) + pointOf(largest->vertex(1)) + pointOf(largest->vertex(2))) / 3.0);
      isInside.push_back(rule == FillRule::Wound ? count.wound != 0 : count.crossed % 2 != 0);
    }
    if (!isInside[static_cast<std::size_t>(face->info())]) continue;
    std::array<std::uint32_t, 3>& triangle = filled.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& number = face->vertex(k)->info();
      if (number == kUnnumbered) {
        number = static_cast<std::uint32_t>(filled.points.size());
        filled.points.push_back(pointOf(face->vertex(k)));
      }
      triangle[static_cast<std::size_t>(k)] = number;
    }
  }
  return filled;
}

}  // namespace nearfit
