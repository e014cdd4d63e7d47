// Finds cylinders among the facets of a mesh; declared in mesh_region.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <unordered_map>
#include <unordered_set>

#include <glm/geometric.hpp>

#include "core/math/symmetric_eigen.h"
#include "core/placing/cone_fit.h"
#include "core/placing/mesh_region.h"
#include "core/placing/round_corners.h"

namespace nearfit {
namespace {

/// Max distance of corners from a cylinder, as a fraction of its radius: for a first guess, and once refined.
constexpr double kLoose = 0.02, kTight = 2e-3;
/// Max inclination of facets to the axis [sine of the angle]: likewise.
constexpr double kLooseLean = 0.03, kTightLean = 5e-3;
constexpr std::size_t kFewestFacets = 4;
/// Facets that turn less are one flat face [rad], as for cones.
constexpr double kOneFlat = 2e-3;
/// Max width of a facet that a slot or hole cuts, relative to the usual one. A wider one may be a flat.
constexpr double kWidestCut = 2.0;
/// Corners of a facet this near to its ends, as a share of its width, are at them.
constexpr double kAtEnd = 1e-3;

double slackOn(const TriangleMesh& mesh, const Circle& cylinder, double share) {
  return share * cylinder.radius + 1e-7 * mesh.bounds().diagonal();
}

/// How near triangles have to be to a cylinder.
struct Nearness {
  double share, lean;  ///< See kLoose, kLooseLean.
  /// Max angle about the axis of a facet with corners between its ends [rad].
  double widestCut = kRoundRing.widestFacet;
};
constexpr Nearness kFirst{kLoose, kLooseLean}, kRefined{kTight, kTightLean};

/// True if a triangle lies on the flat between two lines along the cylinder. Where a slot or hole cuts a facet, its
/// corners between those lines are nearer to the axis than the cylinder is.
bool isOnFacet(const TriangleMesh& mesh, std::uint32_t triangle, const Circle& cylinder,
               const Nearness& near) {
  const double slack = slackOn(mesh, cylinder, near.share);
  const glm::dvec3 normal = triangleNormal(mesh, triangle);
  if (!(std::abs(glm::dot(normal, cylinder.axis)) <= near.lean)) return false;
  bool isCut = false;
  for (const std::uint32_t v : mesh.triangles()[triangle]) {
    const glm::dvec3 off = mesh.vertices()[v] - cylinder.centre;
    const double above = glm::length(off - glm::dot(off, cylinder.axis) * cylinder.axis) - cylinder.radius;
    if (!(above <= slack)) return false;
    isCut = isCut || above < -slack;
  }
  if (!isCut) return true;
  const glm::dvec3 off = mesh.vertices()[mesh.triangles()[triangle][0]] - cylinder.centre;
  const double height = std::abs(glm::dot(off - glm::dot(off, cylinder.axis) * cylinder.axis, normal));
  return height + slack >= cylinder.radius * std::cos(0.5 * near.widestCut);
}

std::vector<std::uint32_t> onCylinder(const TriangleMesh& mesh, std::uint32_t first, const Circle& cylinder,
                                      const Nearness& near) {
  const auto accepts = [&](std::uint32_t triangle) { return isOnFacet(mesh, triangle, cylinder, near); };
  if (!accepts(first)) return {};
  return grownRegion(mesh, first, accepts);
}

/// Corners of triangles on a cylinder; without those between the ends of facets.
std::vector<glm::dvec3> cornersOn(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles,
                                  const Circle& cylinder) {
  std::vector<glm::dvec3> corners = cornersOf(mesh, triangles);
  const double slack = slackOn(mesh, cylinder, kTight);
  std::erase_if(corners, [&](const glm::dvec3& p) { return cylinder.distanceFromCylinder(p) > slack; });
  return corners;
}

/// Corners of triangles that tell the cylinder: without those between the ends of facets. Where facets of different
/// directions meet, corners are at the ends; others are so if they are on the cylinder through these.
/// @param before  The cylinder so far.
std::vector<glm::dvec3> cornersAtEnds(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles,
                                      const glm::dvec3& axis, const Circle& before) {
  // Corners on one or two lines give any radius.
  constexpr double kUnlike = 2.0;
  struct Seen {
    glm::dvec3 normal;
    bool isAtEnd;
  };
  std::unordered_map<std::uint32_t, Seen> seen;
  for (const std::uint32_t t : triangles) {
    const glm::dvec3 normal = triangleNormal(mesh, t);
    for (const std::uint32_t v : mesh.triangles()[t]) {
      const auto [at, isNew] = seen.try_emplace(v, Seen{normal, false});
      if (!isNew && glm::length(glm::cross(at->second.normal, normal)) > kOneFlat) at->second.isAtEnd = true;
    }
  }
  std::vector<glm::dvec3> atEnds;
  for (const auto& [v, corner] : seen) {
    if (corner.isAtEnd) atEnds.push_back(mesh.vertices()[v]);
  }
  const std::optional<Circle> through = fitCylinder(atEnds, axis);
  if (!through || through->radius > kUnlike * before.radius || kUnlike * through->radius < before.radius)
    return cornersOf(mesh, triangles);
  const double slack = slackOn(mesh, *through, kTight);
  for (const auto& [v, corner] : seen) {
    const glm::dvec3& p = mesh.vertices()[v];
    if (!corner.isAtEnd && through->distanceFromCylinder(p) <= slack) atEnds.push_back(p);
  }
  return atEnds;
}

/// Corners of a flat facet at its ends across an axis.
std::vector<glm::dvec3> endsOf(const TriangleMesh& mesh, std::span<const std::uint32_t> facet,
                               const glm::dvec3& axis) {
  std::vector<glm::dvec3> corners = cornersOf(mesh, facet);
  const glm::dvec3 aside = glm::cross(axis, triangleNormal(mesh, facet.front()));
  const auto along = [&](const glm::dvec3& p) { return glm::dot(p, aside); };
  const auto [lowest, highest] = std::ranges::minmax(corners, {}, along);
  const double from = along(lowest), to = along(highest), near = kAtEnd * (to - from);
  std::erase_if(corners, [&](const glm::dvec3& p) { return along(p) > from + near && along(p) < to - near; });
  return corners;
}

/// Angle between neighbouring lines [rad] that half of the wall is cut as wide as, or wider. Slivers count for little.
double usualWidth(const std::vector<double>& lines) {
  std::vector<double> widths;
  for (std::size_t i = 1; i < lines.size(); ++i)
    widths.push_back(lines[i] - lines[i - 1]);
  std::ranges::sort(widths);
  double rest = 0.5 * std::accumulate(widths.begin(), widths.end(), 0.0);
  for (const double width : widths) {
    rest -= width;
    if (rest <= 0.0) return width;
  }
  return 0.0;
}

/// Refines the cylinder. Its axis is the direction along which the facets' normals have the smallest
/// components.
Circle refined(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles, const Circle& before) {
  glm::dmat3 normals(0.0);
  for (const std::uint32_t t : triangles) {
    const Triangle& c = mesh.triangles()[t];
    const glm::dvec3 normal = glm::cross(mesh.vertices()[c[1]] - mesh.vertices()[c[0]],
                                         mesh.vertices()[c[2]] - mesh.vertices()[c[0]]);
    normals += glm::outerProduct(normal, normal);
  }
  glm::dvec3 axis = symmetricEigen(normals).vectors[0];
  if (glm::dot(axis, before.axis) < 0.0) axis = -axis;
  return fitCylinder(cornersAtEnds(mesh, triangles, axis, before), axis).value_or(before);
}

std::optional<CylinderRegion> grown(const TriangleMesh& mesh, std::uint32_t first, const Circle& guess) {
  const std::vector<std::uint32_t> triangles = onCylinder(mesh, first, guess, kFirst);
  if (triangles.size() < kFewestFacets) return std::nullopt;
  CylinderRegion region;
  region.cylinder = refined(mesh, triangles, guess);
  region.triangles = onCylinder(mesh, first, region.cylinder, kFirst);
  if (region.triangles.size() < kFewestFacets) return std::nullopt;
  region.cylinder = refined(mesh, region.triangles, region.cylinder);
  const auto linesOn = [&](const std::vector<std::uint32_t>& on) {
    return linesAbout(cornersOn(mesh, on, region.cylinder), region.cylinder.centre, region.cylinder.axis);
  };
  Nearness near = kRefined;
  const double usual = usualWidth(linesOn(onCylinder(mesh, first, region.cylinder, near)));
  near.widestCut = std::min(near.widestCut, kWidestCut * usual);
  region.triangles = onCylinder(mesh, first, region.cylinder, near);
  const std::vector<glm::dvec3> corners = cornersOn(mesh, region.triangles, region.cylinder);
  if (region.triangles.size() < kFewestFacets || corners.empty()) return std::nullopt;
  const std::vector<double> lines = linesOn(region.triangles);
  region.isRing = isRing(lines, kRoundRing);
  if (!region.isRing && !isFineArc(lines)) return std::nullopt;
  if (region.isRing) {
    // Corners are on the cylinder, and facets are not along it where they are slivers between unlike corners.
    const Circle& c = region.cylinder;
    const std::optional<Cone> fitted = fitCone(corners, Cone{c.centre, c.axis, c.radius, 0.0}, true);
    if (fitted) region.cylinder = {fitted->centre, fitted->axis, fitted->radius};
  }
  double lowest = glm::dot(corners[0] - region.cylinder.centre, region.cylinder.axis), highest = lowest;
  for (const glm::dvec3& p : corners) {
    const double height = glm::dot(p - region.cylinder.centre, region.cylinder.axis);
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  }
  region.cylinder.centre += 0.5 * (lowest + highest) * region.cylinder.axis;
  return region;
}

}  // namespace

std::optional<CylinderRegion> cylinderRegion(const TriangleMesh& mesh, std::uint32_t triangle) {
  std::optional<CylinderRegion> best;
  const std::vector<std::uint32_t> facet = facetOf(mesh, triangle);
  const glm::dvec3 normal = triangleNormal(mesh, triangle);
  const std::unordered_set<std::uint32_t> own(facet.begin(), facet.end());
  const auto take = [&](const std::optional<Circle>& guess) {
    if (!guess) return;
    std::optional<CylinderRegion> found = grown(mesh, triangle, *guess);
    if (found && (!best || found->triangles.size() > best->triangles.size())) best = std::move(found);
  };
  for (const std::uint32_t t : facet) {
    for (const std::uint32_t edge : mesh.edgesOfTriangle(t)) {
      const auto faces = mesh.facesOfEdge(edge);
      if (isSharp(mesh, edge) || own.contains(faces[0] == t ? faces[1] : faces[0])) continue;
      const std::uint32_t other = faces[0] == t ? faces[1] : faces[0];
      const MeshEdge& e = mesh.edges()[edge];
      const std::vector<std::uint32_t> beside = facetOf(mesh, other);
      std::vector<std::uint32_t> both = beside;
      both.insert(both.end(), facet.begin(), facet.end());
      const std::vector<glm::dvec3> corners = cornersOf(mesh, both);
      // If the facets run along the axis, so does their common edge. Otherwise the cross product of
      // their normals does.
      const glm::dvec3 axes[] = {mesh.vertices()[e.v1] - mesh.vertices()[e.v0],
                                 glm::cross(normal, triangleNormal(mesh, other))};
      for (const glm::dvec3& axis : axes) {
        if (!(glm::length(axis) > 0.0)) continue;
        const glm::dvec3 unit = glm::normalize(axis);
        take(fitCylinder(corners, unit));
        // A slot or hole leaves corners between the ends of facets, off the cylinder.
        std::vector<glm::dvec3> ends = endsOf(mesh, facet, unit);
        const std::vector<glm::dvec3> others = endsOf(mesh, beside, unit);
        ends.insert(ends.end(), others.begin(), others.end());
        take(fitCylinder(ends, unit));
      }
    }
    // One edge that leads to a cylinder is enough.
    if (best) return best;
  }
  return best;
}

}  // namespace nearfit
