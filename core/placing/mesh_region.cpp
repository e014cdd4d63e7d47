#include "core/placing/mesh_region.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// Tolerances for planes in single precision: height as a fraction of the mesh's size, and direction of
/// triangles that are not slivers [rad].
constexpr double kPlaneHeight = 2e-6, kPlaneTurn = 2e-3;

glm::dvec3 doubleArea(const TriangleMesh& mesh, std::uint32_t triangle) noexcept {
  const Triangle& t = mesh.triangles()[triangle];
  const auto vertices = mesh.vertices();
  return glm::cross(vertices[t[1]] - vertices[t[0]], vertices[t[2]] - vertices[t[0]]);
}

std::uint32_t largestOf(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  return *std::max_element(triangles.begin(), triangles.end(), [&](std::uint32_t a, std::uint32_t b) {
    return glm::length(doubleArea(mesh, a)) < glm::length(doubleArea(mesh, b));
  });
}

std::vector<std::uint32_t> inPlaneOf(const TriangleMesh& mesh, std::uint32_t triangle, std::uint32_t first) {
  const glm::dvec3 normal = triangleNormal(mesh, triangle);
  const glm::dvec3 point = mesh.vertices()[mesh.triangles()[triangle][0]];
  const double height = kPlaneHeight * mesh.bounds().diagonal();
  return grownRegion(mesh, first, [&](std::uint32_t other) {
    const Triangle& t = mesh.triangles()[other];
    const auto isNear = [&](std::uint32_t v) {
      return std::abs(glm::dot(mesh.vertices()[v] - point, normal)) <= height;
    };
    if (!isNear(t[0]) || !isNear(t[1]) || !isNear(t[2])) return false;
    // A small facet of something round may be as near. A sliver's direction is unreliable.
    const glm::dvec3 area = doubleArea(mesh, other);
    const double turn = kPlaneTurn * glm::length(area) + height * mesh.bounds().diagonal() * kPlaneTurn;
    return glm::dot(area, normal) >= 0.0 && glm::length(glm::cross(area, normal)) <= turn;
  });
}

}  // namespace

glm::dvec3 triangleNormal(const TriangleMesh& mesh, std::uint32_t triangle) noexcept {
  const glm::dvec3 area = doubleArea(mesh, triangle);
  const double length = glm::length(area);
  return length > 0.0 ? area / length : glm::dvec3(0.0);
}

glm::dvec3 centroidOf(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) noexcept {
  glm::dvec3 moment(0.0);
  double total = 0.0;
  for (const std::uint32_t t : triangles) {
    const double area = glm::length(doubleArea(mesh, t));
    const Triangle& c = mesh.triangles()[t];
    moment += area / 3.0 * (mesh.vertices()[c[0]] + mesh.vertices()[c[1]] + mesh.vertices()[c[2]]);
    total += area;
  }
  return total > 0.0 ? moment / total : mesh.vertices()[mesh.triangles()[triangles.front()][0]];
}

bool isSharp(const TriangleMesh& mesh, std::uint32_t edge) noexcept {
  const auto faces = mesh.facesOfEdge(edge);
  if (faces.size() != 2 || !mesh.isEdgeConsistent(edge)) return true;
  const double turn = glm::dot(triangleNormal(mesh, faces[0]), triangleNormal(mesh, faces[1]));
  return turn < std::cos(kSharpTurn);
}

PlaneRegion planeRegion(const TriangleMesh& mesh, std::uint32_t triangle) {
  PlaneRegion region;
  if (triangleNormal(mesh, triangle) == glm::dvec3(0.0)) return region;
  // A large triangle determines the plane better than a small one.
  const std::uint32_t largest = largestOf(mesh, inPlaneOf(mesh, triangle, triangle));
  region.triangles = inPlaneOf(mesh, largest, triangle);
  glm::dvec3 area(0.0);
  for (const std::uint32_t t : region.triangles)
    area += doubleArea(mesh, t);
  region.normal = glm::normalize(area);
  region.point = centroidOf(mesh, region.triangles);
  return region;
}

}  // namespace nearfit
