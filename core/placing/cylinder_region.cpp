// Finds cylinders among the facets of a mesh; declared in mesh_region.h.
#include <algorithm>
#include <cmath>

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

std::vector<std::uint32_t> onCylinder(const TriangleMesh& mesh, std::uint32_t first, const Circle& cylinder,
                                      double share, double lean) {
  const double slack = share * cylinder.radius + 1e-7 * mesh.bounds().diagonal();
  const auto accepts = [&](std::uint32_t triangle) {
    for (const std::uint32_t v : mesh.triangles()[triangle]) {
      if (!(cylinder.distanceFromCylinder(mesh.vertices()[v]) <= slack)) return false;
    }
    const glm::dvec3 normal = triangleNormal(mesh, triangle);
    return std::abs(glm::dot(normal, cylinder.axis)) <= lean;
  };
  if (!accepts(first)) return {};
  return grownRegion(mesh, first, accepts);
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
  return fitCylinder(cornersOf(mesh, triangles), axis).value_or(before);
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
  const std::vector<glm::dvec3> corners = cornersOf(mesh, region.triangles);
  if (region.triangles.size() < kFewestFacets) return std::nullopt;
  const std::vector<double> lines = linesAbout(corners, region.cylinder.centre, region.cylinder.axis);
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

}  // namespace nearfit
