#include "core/math/min_norm_point.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// Up to four points of the hull whose own hull contains the point nearest to the origin so far.
struct Simplex {
  std::array<glm::dvec3, 4> points{};
  std::size_t size = 0;
};

/// Finds the point nearest to the origin in the affine hull of the first `n` points. Returns false if the
/// points are dependent or that point is outside their convex hull.
bool nearestOfAffineHull(const std::array<glm::dvec3, 4>& p, std::size_t n, glm::dvec3& nearest) {
  if (n == 1) {
    nearest = p[0];
    return true;
  }
  if (n == 2) {
    const glm::dvec3 e = p[1] - p[0];
    const double ee = glm::dot(e, e), w = -glm::dot(p[0], e);
    if (!(ee > 0.0) || w < 0.0 || w > ee) return false;
    nearest = p[0] + (w / ee) * e;
    return true;
  }
  if (n == 3) {
    const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double nn = glm::dot(normal, normal);
    if (!(nn > 0.0)) return false;
    nearest = normal * (glm::dot(normal, p[0]) / nn);
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 a = p[k] - nearest, b = p[(k + 1) % 3] - nearest;
      if (glm::dot(glm::cross(a, b), normal) < 0.0) return false;
    }
    return true;
  }
  // With four points the origin is inside, or else a face is nearer.
  nearest = glm::dvec3(0.0);
  for (std::size_t k = 0; k < 4; ++k) {
    const glm::dvec3 &a = p[(k + 1) % 4], &b = p[(k + 2) % 4], &c = p[(k + 3) % 4];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double apex = glm::dot(normal, p[k] - a), origin = -glm::dot(normal, a);
    if (apex == 0.0 || (apex > 0.0) != (origin > 0.0)) return false;
  }
  return true;
}

/// Reduces the simplex to its smallest sub-simplex that contains the nearest point; returns that point.
glm::dvec3 reduce(Simplex& simplex) {
  glm::dvec3 best(0.0);
  double bestSquared = -1.0;
  Simplex kept;
  for (std::size_t mask = 1; mask < (std::size_t{1} << simplex.size); ++mask) {
    Simplex candidate;
    for (std::size_t i = 0; i < simplex.size; ++i) {
      if ((mask >> i & 1U) != 0) candidate.points[candidate.size++] = simplex.points[i];
    }
    glm::dvec3 nearest;
    if (!nearestOfAffineHull(candidate.points, candidate.size, nearest)) continue;
    const double squared = glm::dot(nearest, nearest);
    if (bestSquared < 0.0 || squared < bestSquared) {
      best = nearest;
      bestSquared = squared;
      kept = candidate;
    }
  }
  simplex = kept;
  return best;
}

}  // namespace

glm::dvec3 minNormPoint(std::span<const glm::dvec3> points) {
  if (points.empty()) return glm::dvec3(0.0);
  Simplex simplex;
  simplex.points[0] = points[0];
  simplex.size = 1;
  glm::dvec3 nearest = points[0];
  // A few iterations suffice; the limit only ends cycles caused by rounding.
  constexpr int kMaxIterations = 128;
  // Stop when the hull can come nearer by no more than a few roundings of the points. A fraction of the
  // squared norm would stop early at hulls that pass close to the origin, by up to its square root.
  constexpr double kConverged = 1e-14;
  for (int i = 0; i < kMaxIterations && simplex.size < 4; ++i) {
    const auto support = std::min_element(points.begin(), points.end(), [&](const auto& a, const auto& b) {
      return glm::dot(a, nearest) < glm::dot(b, nearest);
    });
    const double squared = glm::dot(nearest, nearest);
    const double norm = std::sqrt(squared), reach = std::max(norm, glm::length(*support));
    if (squared - glm::dot(*support, nearest) <= kConverged * norm * reach) break;
    simplex.points[simplex.size++] = *support;
    const glm::dvec3 next = reduce(simplex);
    if (glm::dot(next, next) >= squared) break;
    nearest = next;
  }
  return nearest;
}

}  // namespace nearfit
