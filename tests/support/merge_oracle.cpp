#include "tests/support/merge_oracle.h"

#include <algorithm>
#include <numeric>
#include <span>

#include <glm/geometric.hpp>

#include "core/proximity/query/leaf_tests.h"
#include "core/proximity/query/query_workspace.h"

namespace nearfit::test {
namespace {

double pointSegmentDistance(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 e = b - a;
  const double ee = glm::dot(e, e);
  const double s = ee > 0.0 ? std::clamp(glm::dot(p - a, e) / ee, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + s * e);
}

/// Corners of a piece, or the point twice.
std::vector<glm::dvec3> outline(const Minimum& m) {
  if (m.dimension == 0) return {m.lmd.scenePoint, m.lmd.scenePoint};
  return {m.corners.begin(), m.corners.begin() + m.cornerCount};
}

bool sidesMeet(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d,
               double tolerance) {
  const double ends = std::min({pointSegmentDistance(a, c, d), pointSegmentDistance(b, c, d),
                                pointSegmentDistance(c, a, b), pointSegmentDistance(d, a, b)});
  if (ends <= tolerance) return true;
  const glm::dvec3 e = b - a, f = d - c, n = glm::cross(e, f);
  const double nn = glm::dot(n, n);
  if (!(nn > 0.0)) return false;
  const double s = glm::dot(glm::cross(c - a, f), n) / nn, t = glm::dot(glm::cross(c - a, e), n) / nn;
  if (s < 0.0 || s > 1.0 || t < 0.0 || t > 1.0) return false;
  return glm::distance(a + s * e, c + t * f) <= tolerance;
}

bool contains(const Minimum& m, const glm::dvec3& p) {
  if (m.dimension != 2) return false;
  const std::vector<glm::dvec3> corners = outline(m);
  bool left = true, right = true;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec3 &a = corners[i], &b = corners[(i + 1) % corners.size()];
    const double turn = glm::dot(glm::cross(b - a, p - a), m.lmd.direction);
    left = left && turn >= 0.0;
    right = right && turn <= 0.0;
  }
  return left || right;
}

bool touchByAllSides(const Minimum& a, const Minimum& b, double tolerance) {
  if (a.dimension == 0 && b.dimension == 0) {
    return glm::distance(a.lmd.scenePoint, b.lmd.scenePoint) <= tolerance &&
           glm::distance(a.lmd.partPoint, b.lmd.partPoint) <= tolerance;
  }
  if (contains(a, b.lmd.scenePoint) || contains(b, a.lmd.scenePoint)) return true;
  const std::vector<glm::dvec3> pa = outline(a), pb = outline(b);
  for (std::size_t i = 0; i < pa.size(); ++i) {
    for (std::size_t j = 0; j < pb.size(); ++j) {
      if (sidesMeet(pa[i], pa[(i + 1) % pa.size()], pb[j], pb[(j + 1) % pb.size()], tolerance)) return true;
    }
  }
  return false;
}

/// Whether a line along a side of `a` has `b` on its other side.
bool isApartAlongSide(const Minimum& a, const Minimum& b, double tolerance) {
  for (std::size_t i = 0; i < a.cornerCount; ++i) {
    glm::dvec3 inward = glm::cross(a.lmd.direction, a.corners[(i + 1) % a.cornerCount] - a.corners[i]);
    const double length = glm::length(inward);
    if (!(length > tolerance)) continue;
    inward *= (glm::dot(inward, a.lmd.scenePoint - a.corners[i]) < 0.0 ? -1.0 : 1.0) / length;
    const auto isBeyond = [&](const glm::dvec3& p) {
      return glm::dot(inward, p - a.corners[i]) <= tolerance;
    };
    if (std::all_of(b.corners.begin(), b.corners.begin() + b.cornerCount, isBeyond)) return true;
  }
  return false;
}

bool coverMoreThanTheirEnds(const Minimum& a, const Minimum& b, double tolerance) {
  const glm::dvec3 along = (a.corners[1] - a.corners[0]) / a.weight;
  double least = a.weight, most = 0.0;
  for (std::size_t k = 0; k < 2; ++k) {
    const glm::dvec3 w = b.corners[k] - a.corners[0];
    const double s = glm::dot(w, along);
    if (glm::distance(w, s * along) > tolerance) return false;
    least = std::min(least, s);
    most = std::max(most, s);
  }
  return std::min(a.weight, most) - std::max(0.0, least) > tolerance;
}

bool markIfOverlapping(Minimum& a, Minimum& b, double tolerance) {
  if (a.dimension != b.dimension || a.dimension == 0) return false;
  const bool overlap = a.dimension == 1
                           ? coverMoreThanTheirEnds(a, b, tolerance)
                           : !isApartAlongSide(a, b, tolerance) && !isApartAlongSide(b, a, tolerance);
  if (overlap) a.isOverlapping = b.isOverlapping = true;
  return overlap;
}

std::vector<std::uint32_t> leavesOf(const NormalConeTree& tree) {
  std::vector<std::uint32_t> leaves;
  const auto add = [&](FeatureKind kind, std::size_t count) {
    for (std::uint32_t i = 0; i < count; ++i)
      leaves.push_back(NormalConeTree::kLeafBit | static_cast<std::uint32_t>(kind) << 29 | i);
  };
  add(FeatureKind::Vertex, tree.vertices().size());
  add(FeatureKind::Edge, tree.edges().size());
  add(FeatureKind::Face, tree.faces().size());
  return leaves;
}

}  // namespace

std::vector<Minimum> unmergedMinima(const NormalConeTree& scene, const NormalConeTree& part,
                                    const RigidTransform& sceneFromPart, double cutoff) {
  const LeafTests tests(scene, part, centredPose(scene, part, sceneFromPart), cutoff);
  std::vector<Minimum> minima;
  const std::vector<std::uint32_t> partLeaves = leavesOf(part);
  for (const std::uint32_t a : leavesOf(scene)) {
    for (const std::uint32_t b : partLeaves) {
      Minimum m;
      if (tests.test(a, b, m)) minima.push_back(m);
    }
  }
  return minima;
}

std::vector<std::uint32_t> setsByAllPairs(std::vector<Minimum>& minima, const TouchTolerances& closeness) {
  std::vector<std::uint32_t> first(minima.size());
  std::iota(first.begin(), first.end(), 0U);
  for (std::uint32_t i = 0; i < minima.size(); ++i) {
    for (std::uint32_t j = i + 1; j < minima.size(); ++j) {
      Minimum &a = minima[i], &b = minima[j];
      if (!canTouch(a, b, closeness)) continue;
      const double overlap = closeness.ofOverlap(std::max(a.lmd.distance, b.lmd.distance));
      const bool isOne = markIfOverlapping(a, b, overlap) || touchByAllSides(a, b, closeness.of(a, b));
      if (!isOne || first[i] == first[j]) continue;
      const auto [least, greatest] = std::minmax(first[i], first[j]);
      const std::uint32_t from = greatest, to = least;
      std::replace(first.begin(), first.end(), from, to);
    }
  }
  return first;
}

}  // namespace nearfit::test
