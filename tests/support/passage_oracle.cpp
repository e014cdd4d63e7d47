#include "tests/support/passage_oracle.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace nearfit::test {
namespace {

/// Coordinates below 4 have 32 bits on this grid, so that a volume fits in 128.
constexpr double kGrid = 1073741824.0;

__extension__ using Whole = __int128;

/// On which side of the plane through a, b and c the point d lies: the sign of a volume.
int side(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  const auto from = [&d](const GridPoint& p) {
    return std::array<Whole, 3>{p.x - d.x, p.y - d.y, p.z - d.z};
  };
  const auto u = from(a), v = from(b), w = from(c);
  const Whole volume = u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
                       u[2] * (v[0] * w[1] - v[1] * w[0]);
  return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

/// Through the triangle's interior, from one side to the other.
bool crosses(const GridPoint& p, const GridPoint& q, const GridPoint* t) {
  if (side(t[0], t[1], t[2], p) * side(t[0], t[1], t[2], q) >= 0) return false;
  const int s = side(p, q, t[0], t[1]);
  return s != 0 && side(p, q, t[1], t[2]) == s && side(p, q, t[2], t[0]) == s;
}

double segmentsApart(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  const auto toSegment = [](const glm::dvec3& p, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 e = to - from;
    const double ee = glm::dot(e, e);
    const double s = ee > 0.0 ? std::clamp(glm::dot(p - from, e) / ee, 0.0, 1.0) : 0.0;
    return glm::distance(p, from + s * e);
  };
  double nearest = std::min({toSegment(a, c, d), toSegment(b, c, d), toSegment(c, a, b), toSegment(d, a, b)});
  const glm::dvec3 across = glm::cross(b - a, d - c);
  const double length = glm::length(across);
  if (!(length > 1e-12 * glm::distance(a, b) * glm::distance(c, d))) return nearest;
  const double s = glm::dot(glm::cross(c - a, d - c), across) / (length * length);
  const double t = glm::dot(glm::cross(c - a, b - a), across) / (length * length);
  if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0)
    nearest = std::min(nearest, std::abs(glm::dot(c - a, across)) / length);
  return nearest;
}

/// From a point to a triangle where its foot is inside; infinity elsewhere (its edges are then nearer).
double footDistance(const glm::dvec3& p, const glm::dvec3* t) {
  const glm::dvec3 n = glm::normalize(glm::cross(t[1] - t[0], t[2] - t[0]));
  for (std::size_t k = 0; k < 3; ++k) {
    if (glm::dot(glm::cross(n, t[(k + 1) % 3] - t[k]), p - t[k]) < 0.0)
      return std::numeric_limits<double>::infinity();
  }
  return std::abs(glm::dot(n, p - t[0]));
}

}  // namespace

GridPoint toGrid(const glm::dvec3& p) {
  assert(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) < 4.0);
  return {std::llround(p.x * kGrid), std::llround(p.y * kGrid), std::llround(p.z * kGrid)};
}

PassageOracle::PassageOracle(const TriangleMesh& mesh, const RigidTransform& sceneFromBody) {
  for (const Triangle& t : mesh.triangles()) {
    Corners c;
    for (std::size_t k = 0; k < 3; ++k) {
      c.points[k] = sceneFromBody.applyToPoint(mesh.vertices()[t[k]]);
      c.grid[k] = toGrid(c.points[k]);
    }
    triangles_.push_back(c);
  }
}

Passage PassageOracle::passage(const glm::dvec3& p, const glm::dvec3& q, double tolerance) const {
  const double length = glm::distance(p, q);
  if (length < 6.0 * tolerance) return Passage::Marginal;
  const glm::dvec3 along = (q - p) / length;
  const glm::dvec3 from = p + 2.0 * tolerance * along, to = q - 2.0 * tolerance * along;
  const GridPoint fromGrid = toGrid(from), toGridPoint = toGrid(to);
  Passage result = Passage::Free;
  for (const Corners& t : triangles_) {
    double edges = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k)
      edges = std::min(edges, segmentsApart(from, to, t.points[k], t.points[(k + 1) % 3]));
    const double ends = std::min(footDistance(from, t.points), footDistance(to, t.points));
    if (edges > tolerance && ends > tolerance) {
      // Nothing closes again what a surface closes for sure.
      if (crosses(fromGrid, toGridPoint, t.grid)) return Passage::Blocked;
    } else {
      result = Passage::Marginal;
    }
  }
  return result;
}

bool PassageOracle::meets(const PassageOracle& other) const {
  const auto edgesCross = [](const Corners& a, const Corners& b) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (crosses(a.grid[k], a.grid[(k + 1) % 3], b.grid)) return true;
    }
    return false;
  };
  for (const Corners& a : triangles_) {
    for (const Corners& b : other.triangles_) {
      if (edgesCross(a, b) || edgesCross(b, a)) return true;
    }
  }
  return false;
}

}  // namespace nearfit::test
