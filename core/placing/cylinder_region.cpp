// Finds cylinders among the facets of a mesh; declared in mesh_region.h.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
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
/// Max width of a facet that a slot or hole cuts, relative to the usual one. A wider one may be a flat.
constexpr double kWidestCut = 2.0;
/// Corners this many times as far from the cylinder as the middle one of all are off it.
constexpr double kOutlier = 4.0;
/// Times that corners off the cylinder are left out of a fit: each takes most of the bias of those before it away.
constexpr int kTrims = 4;

double slackOn(const TriangleMesh& mesh, const Circle& cylinder, double share) {
  return share * cylinder.radius + 1e-7 * mesh.bounds().diagonal();
}

double distanceFromAxis(const Circle& cylinder, const glm::dvec3& p) {
  const glm::dvec3 off = p - cylinder.centre;
  return glm::length(off - glm::dot(off, cylinder.axis) * cylinder.axis);
}

bool isOnCylinder(const TriangleMesh& mesh, std::uint32_t triangle, const Circle& cylinder, double share,
                  double lean) {
  const double slack = slackOn(mesh, cylinder, share);
  for (const std::uint32_t v : mesh.triangles()[triangle]) {
    if (!(cylinder.distanceFromCylinder(mesh.vertices()[v]) <= slack)) return false;
  }
  return std::abs(glm::dot(triangleNormal(mesh, triangle), cylinder.axis)) <= lean;
}

std::vector<std::uint32_t> onCylinder(const TriangleMesh& mesh, std::uint32_t first, const Circle& cylinder,
                                      double share, double lean) {
  const auto accepts = [&](std::uint32_t triangle) {
    return isOnCylinder(mesh, triangle, cylinder, share, lean);
  };
  if (!accepts(first)) return {};
  return grownRegion(mesh, first, accepts);
}

/// True if a triangle is a piece of a facet that a slot or hole cuts: its plane and the cylinder meet in two lines, at
/// most `widest` [rad] apart about the axis, and its corners are between them.
bool isCutFacet(const TriangleMesh& mesh, std::uint32_t triangle, const Circle& cylinder, double widest) {
  const glm::dvec3 normal = triangleNormal(mesh, triangle);
  if (normal == glm::dvec3(0.0) || std::abs(glm::dot(normal, cylinder.axis)) > kTightLean) return false;
  const Triangle& corners = mesh.triangles()[triangle];
  const double slack = slackOn(mesh, cylinder, kTight);
  for (const std::uint32_t v : corners) {
    if (!(distanceFromAxis(cylinder, mesh.vertices()[v]) <= cylinder.radius + slack)) return false;
  }
  const double depth = std::abs(glm::dot(normal, mesh.vertices()[corners[0]] - cylinder.centre));
  return depth >= cylinder.radius * std::cos(0.5 * widest) - slack;
}

/// Angle between neighbouring lines [rad] such that half of the wall is cut as wide, or wider. Slivers count for little.
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

/// Leaves out corners nearer to the axis than the cylinder, as a slot leaves them between the ends of a facet.
void dropCornersInside(std::vector<glm::dvec3>& corners, const TriangleMesh& mesh, const Circle& cylinder) {
  const double least = cylinder.radius - slackOn(mesh, cylinder, kTight);
  std::erase_if(corners, [&](const glm::dvec3& p) { return distanceFromAxis(cylinder, p) < least; });
}

/// Fits a cylinder to corners, of which a minority may be inside it.
std::optional<Circle> fitToWall(const TriangleMesh& mesh, std::vector<glm::dvec3> corners,
                                const glm::dvec3& axis) {
  const std::optional<Circle> all = fitCylinder(corners, axis);
  const std::size_t count = corners.size();
  std::optional<Circle> fitted = all;
  for (int trim = 0; trim < kTrims && fitted; ++trim) {
    const std::size_t before = corners.size();
    dropCornersInside(corners, mesh, *fitted);
    if (2 * corners.size() < count) return all;
    if (corners.size() == before) return fitted;
    fitted = fitCylinder(corners, axis);
  }
  return fitted ? fitted : all;
}

/// Leaves out the corners that are much farther from a cylinder than half of them are; keeps them where that is of the
/// size of rounding.
void dropOutliers(std::vector<glm::dvec3>& corners, const TriangleMesh& mesh, const Circle& cylinder) {
  std::vector<double> distances;
  for (const glm::dvec3& p : corners)
    distances.push_back(cylinder.distanceFromCylinder(p));
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::ranges::nth_element(distances, middle);
  const double most = kOutlier * *middle + slackOn(mesh, cylinder, 0.0);
  std::erase_if(corners, [&](const glm::dvec3& p) { return cylinder.distanceFromCylinder(p) > most; });
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
  return fitToWall(mesh, cornersOf(mesh, triangles), axis).value_or(before);
}

/// Adds the facets that slots and holes cut.
void addCutFacets(const TriangleMesh& mesh, CylinderRegion& region) {
  const Circle& cylinder = region.cylinder;
  const double widest =
      kWidestCut * usualWidth(linesAbout(cornersOf(mesh, region.triangles), cylinder.centre, cylinder.axis));
  region.triangles = grownRegion(mesh, region.triangles.front(), [&](std::uint32_t triangle) {
    return isOnCylinder(mesh, triangle, cylinder, kTight, kTightLean) ||
           isCutFacet(mesh, triangle, cylinder, widest);
  });
}

/// Fits a cylinder to the corners of a ring: they are on it, and facets are not along it where they are slivers between
/// unlike corners.
void fitRing(const TriangleMesh& mesh, std::vector<glm::dvec3> corners, Circle& cylinder) {
  const auto fit = [&] {
    const std::optional<Cone> fitted =
        fitCone(corners, Cone{cylinder.centre, cylinder.axis, cylinder.radius, 0.0}, true);
    if (fitted) cylinder = {fitted->centre, fitted->axis, fitted->radius};
  };
  fit();
  // Corners of slots that are off it by less than kTight are left.
  const std::size_t count = corners.size();
  dropOutliers(corners, mesh, cylinder);
  if (corners.size() < count) fit();
}

std::optional<CylinderRegion> grown(const TriangleMesh& mesh, std::uint32_t first, const Circle& guess) {
  std::vector<std::uint32_t> triangles = onCylinder(mesh, first, guess, kLoose, kLooseLean);
  if (triangles.size() < kFewestFacets) return std::nullopt;
  CylinderRegion region;
  region.cylinder = refined(mesh, triangles, guess);
  region.triangles = onCylinder(mesh, first, region.cylinder, kLoose, kLooseLean);
  if (region.triangles.size() < kFewestFacets) return std::nullopt;
  region.cylinder = refined(mesh, region.triangles, region.cylinder);
  region.triangles = onCylinder(mesh, first, region.cylinder, kTight, kTightLean);
  if (region.triangles.size() < kFewestFacets) return std::nullopt;
  addCutFacets(mesh, region);
  std::vector<glm::dvec3> corners = cornersOf(mesh, region.triangles);
  dropCornersInside(corners, mesh, region.cylinder);
  if (corners.empty()) return std::nullopt;
  const std::vector<double> lines = linesAbout(corners, region.cylinder.centre, region.cylinder.axis);
  region.isRing = isRing(lines, kRoundRing);
  if (!region.isRing && !isFineArc(lines)) return std::nullopt;
  if (region.isRing) {
    fitRing(mesh, corners, region.cylinder);
    // Facets that were missed because corners of a slot had drawn the cylinder aside.
    addCutFacets(mesh, region);
    corners = cornersOf(mesh, region.triangles);
    dropCornersInside(corners, mesh, region.cylinder);
    if (corners.empty()) return std::nullopt;
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

/// The cylinder that a triangle's facet and one beside it tell.
std::optional<CylinderRegion> regionFrom(const TriangleMesh& mesh, std::uint32_t triangle) {
  std::optional<CylinderRegion> best;
  const std::vector<std::uint32_t> facet = facetOf(mesh, triangle);
  const glm::dvec3 normal = triangleNormal(mesh, triangle);
  const std::unordered_set<std::uint32_t> own(facet.begin(), facet.end());
  for (const std::uint32_t t : facet) {
    for (const std::uint32_t edge : mesh.edgesOfTriangle(t)) {
      const auto faces = mesh.facesOfEdge(edge);
      if (isSharp(mesh, edge) || own.contains(faces[0] == t ? faces[1] : faces[0])) continue;
      const std::uint32_t other = faces[0] == t ? faces[1] : faces[0];
      const MeshEdge& e = mesh.edges()[edge];
      std::vector<std::uint32_t> both = facetOf(mesh, other);
      both.insert(both.end(), facet.begin(), facet.end());
      const std::vector<glm::dvec3> corners = cornersOf(mesh, both);
      // If the facets run along the axis, so does their common edge. Otherwise the cross product of
      // their normals does.
      const glm::dvec3 axes[] = {mesh.vertices()[e.v1] - mesh.vertices()[e.v0],
                                 glm::cross(normal, triangleNormal(mesh, other))};
      for (const glm::dvec3& axis : axes) {
        if (!(glm::length(axis) > 0.0)) continue;
        const std::optional<Circle> guess = fitCylinder(corners, glm::normalize(axis));
        if (!guess) continue;
        std::optional<CylinderRegion> found = grown(mesh, triangle, *guess);
        if (found && (!best || found->triangles.size() > best->triangles.size())) best = std::move(found);
      }
    }
    // One edge that leads to a cylinder is enough.
    if (best) return best;
  }
  return best;
}

/// Triangles of the facets nearest to one's own, one of each, across edges that are not sharp; nearest first.
std::vector<std::uint32_t> facetsToTry(const TriangleMesh& mesh, std::uint32_t triangle) {
  // Slots rarely cut more facets side by side, and each takes a search.
  constexpr std::size_t kMost = 12;
  std::vector<std::uint32_t> reached{triangle};
  std::unordered_set<std::uint32_t> seen;
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const std::vector<std::uint32_t> facet = facetOf(mesh, reached[next]);
    seen.insert(facet.begin(), facet.end());
    for (const std::uint32_t t : facet) {
      for (const std::uint32_t edge : mesh.edgesOfTriangle(t)) {
        if (isSharp(mesh, edge)) continue;
        const auto faces = mesh.facesOfEdge(edge);
        const std::uint32_t other = faces[0] == t ? faces[1] : faces[0];
        if (reached.size() <= kMost && seen.insert(other).second) reached.push_back(other);
      }
    }
  }
  reached.erase(reached.begin());
  return reached;
}

}  // namespace

std::optional<CylinderRegion> cylinderRegion(const TriangleMesh& mesh, std::uint32_t triangle) {
  std::optional<CylinderRegion> best = regionFrom(mesh, triangle);
  if (best && best->isRing) return best;
  // The corners of a facet that a slot cuts tell no cylinder, or a wrong one; those of facets beside it may.
  for (const std::uint32_t other : facetsToTry(mesh, triangle)) {
    std::optional<CylinderRegion> region = regionFrom(mesh, other);
    if (!region || (best && region->triangles.size() <= best->triangles.size())) continue;
    if (std::ranges::find(region->triangles, triangle) == region->triangles.end()) continue;
    best = std::move(region);
    if (best->isRing) break;
  }
  return best;
}

}  // namespace nearfit
