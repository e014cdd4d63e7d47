#include "core/placing/round_corners.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/math/axes_across.h"
#include "core/placing/mesh_region.h"

namespace nearfit {
namespace {

/// Corners whose angles about the axis differ by less lie on one line along it [rad].
constexpr double kSameAngle = 1e-3;
/// Min facets of an arc, and max width of a facet relative to the median one.
constexpr std::size_t kFewestOfAnArc = 4;
constexpr double kWidest = 3.0;
/// Corners nearer to the axis than this share of the farthest one are on it, as the tip of a cone is.
constexpr double kOnAxis = 1e-3;
/// Number of triangles that suffice to locate a flat facet.
constexpr std::size_t kFacetSample = 64;

constexpr double kFullTurn = 2.0 * std::numbers::pi;

/// Angles between neighbouring lines, ascending, the one across the start too.
std::vector<double> widthsOf(const std::vector<double>& lines) {
  std::vector<double> widths;
  for (std::size_t i = 0; i < lines.size(); ++i)
    widths.push_back((i + 1 < lines.size() ? lines[i + 1] : lines.front() + kFullTurn) - lines[i]);
  std::sort(widths.begin(), widths.end());
  return widths;
}

}  // namespace

std::vector<glm::dvec3> cornersOf(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
  std::vector<std::uint32_t> indices;
  for (const std::uint32_t t : triangles)
    indices.insert(indices.end(), mesh.triangles()[t].begin(), mesh.triangles()[t].end());
  std::sort(indices.begin(), indices.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  std::vector<glm::dvec3> corners;
  corners.reserve(indices.size());
  for (const std::uint32_t v : indices)
    corners.push_back(mesh.vertices()[v]);
  return corners;
}

std::vector<std::uint32_t> facetOf(const TriangleMesh& mesh, std::uint32_t triangle) {
  std::vector<std::uint32_t> facet = planeRegion(mesh, triangle).triangles;
  if (facet.size() > kFacetSample) facet.resize(kFacetSample);
  return facet;
}

std::vector<double> linesAbout(std::span<const glm::dvec3> corners, const glm::dvec3& centre,
                               const glm::dvec3& axis) {
  const auto [u, v] = axesAcross(axis);
  const auto awayOf = [&centre, across = u, aside = v](const glm::dvec3& p) {
    return std::hypot(glm::dot(p - centre, across), glm::dot(p - centre, aside));
  };
  double farthest = 0.0;
  for (const glm::dvec3& p : corners)
    farthest = std::max(farthest, awayOf(p));
  std::vector<double> angles;
  angles.reserve(corners.size());
  for (const glm::dvec3& p : corners) {
    if (awayOf(p) > kOnAxis * farthest)
      angles.push_back(std::atan2(glm::dot(p - centre, v), glm::dot(p - centre, u)));
  }
  std::sort(angles.begin(), angles.end());
  angles.erase(
      std::unique(angles.begin(), angles.end(), [](double a, double b) { return b - a < kSameAngle; }),
      angles.end());
  if (angles.size() > 1 && angles.front() + kFullTurn - angles.back() < kSameAngle) angles.pop_back();
  return angles;
}

bool isRing(const std::vector<double>& lines, const RingRule& rule) {
  return lines.size() >= rule.fewestFacets && widthsOf(lines).back() <= rule.widestFacet;
}

bool isFineArc(const std::vector<double>& lines) {
  if (lines.size() <= kFewestOfAnArc) return false;
  const std::vector<double> widths = widthsOf(lines);
  // Ignore the widest: the region may be open there.
  const double widest = widths[widths.size() - 2];
  return widest <= kWidest * widths[widths.size() / 2] && widest <= kSharpTurn + kSameAngle;
}

}  // namespace nearfit
