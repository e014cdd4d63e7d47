#include "core/mesh/polygon_triangulation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <glm/geometric.hpp>

#include "core/base/error.h"

namespace nearfit {
namespace {

/// Max tests of a point against a triangle, over all polygons: about ten seconds. Only malicious
/// files need more.
constexpr std::uint64_t kMaxTests = 2'000'000'000;

/// Twice the signed area of abc: > 0 for a left turn, exactly 0 if rounding could decide the sign.
/// Source: J. Shewchuk, Adaptive precision floating-point arithmetic, 1997 (the first filter of orient2d).
double orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  constexpr double kEpsilon = 0.5 * std::numeric_limits<double>::epsilon();
  constexpr double kErrorBound = (3.0 + 16.0 * kEpsilon) * kEpsilon;
  const double left = (a.x - c.x) * (b.y - c.y), right = (a.y - c.y) * (b.x - c.x);
  const double area = left - right;
  return std::abs(area) <= kErrorBound * (std::abs(left) + std::abs(right)) ? 0.0 : area;
}

/// Twice the vector area of a polygon (Newell), relative to its first corner.
glm::dvec3 vectorArea(std::span<const glm::dvec3> points, std::span<const std::uint32_t> polygon) {
  const glm::dvec3 origin = points[polygon[0]];
  glm::dvec3 sum(0.0);
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
    sum += glm::cross(points[polygon[i]] - origin, points[polygon[i + 1]] - origin);
  }
  return sum;
}

}  // namespace

std::size_t PolygonTriangulator::triangulate(std::span<const glm::dvec3> points,
                                             std::span<const std::uint32_t> polygon,
                                             std::vector<Triangle>& out) {
  const std::size_t before = out.size();
  if (polygon.size() == 3) {
    out.push_back({polygon[0], polygon[1], polygon[2]});
  } else if (polygon.size() == 4) {
    triangulateQuad(points, polygon, out);
  } else {
    project(points, polygon);
    std::uint32_t corner = 0;
    for (std::size_t left = polygon.size(); left > 3; --left) {
      const std::uint32_t ear = findEar(corner, left);
      // Skipping a corner spreads the cuts and gives better triangles than a fan.
      corner = corners_[corners_[ear].next].next;
      cut(ear, out);
    }
    cut(corner, out);
  }
  // A folded bridge or spike gives no triangle.
  const auto isFolded = [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; };
  out.erase(std::remove_if(out.begin() + static_cast<std::ptrdiff_t>(before), out.end(), isFolded),
            out.end());
  return out.size() - before;
}

/// Cuts along the diagonal whose smaller triangle is larger; along the first if they are equal.
void PolygonTriangulator::triangulateQuad(std::span<const glm::dvec3> points,
                                          std::span<const std::uint32_t> quad,
                                          std::vector<Triangle>& out) const {
  if (quad[0] == quad[2] || quad[1] == quad[3]) return;  // A spike has no surface.
  const glm::dvec3 normal = vectorArea(points, quad);
  const auto area = [&](int a, int b, int c) {
    const glm::dvec3 &p = points[quad[a]], &q = points[quad[b]], &r = points[quad[c]];
    return glm::dot(glm::cross(q - p, r - p), normal);
  };
  const double first = std::min(area(0, 1, 2), area(0, 2, 3)),
               second = std::min(area(1, 2, 3), area(1, 3, 0));
  // Rounding must not choose between the diagonals of a square.
  if (second > first + 1e-9 * std::abs(first)) {
    out.push_back({quad[1], quad[2], quad[3]});
    out.push_back({quad[1], quad[3], quad[0]});
  } else {
    out.push_back({quad[0], quad[1], quad[2]});
    out.push_back({quad[0], quad[2], quad[3]});
  }
}

/// Drops the coordinate in which the polygon's normal is largest. The rest is exact, and anticlockwise.
void PolygonTriangulator::project(std::span<const glm::dvec3> points,
                                  std::span<const std::uint32_t> polygon) {
  const glm::dvec3 normal = vectorArea(points, polygon);
  const glm::dvec3 size = glm::abs(normal);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const bool isTurned = normal[axis] < 0.0;
  const int u = (axis + (isTurned ? 2 : 1)) % 3, v = (axis + (isTurned ? 1 : 2)) % 3;

  const auto count = static_cast<std::uint32_t>(polygon.size());
  corners_.resize(count);
  blockers_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec3& p = points[polygon[i]];
    corners_[i] = {{p[u], p[v]}, polygon[i], i == 0 ? count - 1 : i - 1, i + 1 == count ? 0 : i + 1, false};
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    corners_[i].isBlocker = turn(i) <= 0.0;
    if (corners_[i].isBlocker) blockers_.push_back(i);
  }
}

double PolygonTriangulator::turn(std::uint32_t corner) const {
  const Corner& c = corners_[corner];
  return orientation(corners_[c.previous].p, c.p, corners_[c.next].p);
}

bool PolygonTriangulator::isEar(std::uint32_t corner) {
  if (!(turn(corner) > 0.0)) return false;
  const glm::dvec2 a = corners_[corners_[corner].previous].p, b = corners_[corner].p,
                   c = corners_[corners_[corner].next].p;
  tests_ += blockers_.size();
  return std::ranges::none_of(blockers_, [&](std::uint32_t i) {
    const glm::dvec2 p = corners_[i].p;
    // A bridge repeats its corners; the duplicate is no obstacle.
    if (p == a || p == b || p == c) return false;
    return orientation(a, b, p) >= 0.0 && orientation(b, c, p) >= 0.0 && orientation(c, a, p) >= 0.0;
  });
}

/// First ear from `start` on. If there is none, because the polygon crosses or folds onto itself, its
/// most convex corner.
std::uint32_t PolygonTriangulator::findEar(std::uint32_t start, std::size_t left) {
  std::uint32_t corner = start, best = start;
  double bestTurn = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < left; ++i, corner = corners_[corner].next) {
    if (tests_ > kMaxTests) {
      throw Error("polygon of " + std::to_string(corners_.size()) + " corners",
                  "splitting it into triangles takes too long", "export the part as triangles");
    }
    if (isEar(corner)) return corner;
    ++tests_;
    if (const double t = turn(corner); t > bestTurn) {
      bestTurn = t;
      best = corner;
    }
  }
  return best;
}

void PolygonTriangulator::cut(std::uint32_t corner, std::vector<Triangle>& out) {
  const std::uint32_t previous = corners_[corner].previous, next = corners_[corner].next;
  out.push_back({corners_[previous].index, corners_[corner].index, corners_[next].index});
  corners_[previous].next = next;
  corners_[next].previous = previous;
  corners_[corner].isBlocker = false;
  for (const std::uint32_t neighbour : {previous, next}) {
    if (turn(neighbour) > 0.0) corners_[neighbour].isBlocker = false;
  }
  std::erase_if(blockers_, [&](std::uint32_t i) { return !corners_[i].isBlocker; });
}

}  // namespace nearfit
