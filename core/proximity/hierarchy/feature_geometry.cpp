#include "core/proximity/hierarchy/feature_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// Largest cosine between w (unit) and the directions within a cone.
double coneSupport(const NormalCone& cone, const glm::dvec3& w) noexcept {
  const double cosine = glm::dot(cone.axis, w), edge = std::cos(cone.halfAngle);
  if (cosine >= edge) return 1.0;
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return cosine * edge + sine * std::sin(cone.halfAngle);
}

/// Largest cosine between w and the shorter arc from a to b, all unit.
double arcSupport(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& w) noexcept {
  const double ends = std::max(glm::dot(a, w), glm::dot(b, w));
  const glm::dvec3 normal = glm::cross(a, b);
  const double nn = glm::dot(normal, normal);
  if (!(nn > 0.0)) return ends;
  const glm::dvec3 inPlane = w - normal * (glm::dot(w, normal) / nn);
  const bool isBetween =
      glm::dot(glm::cross(a, inPlane), normal) > 0.0 && glm::dot(glm::cross(inPlane, b), normal) > 0.0;
  return isBetween ? std::max(ends, glm::length(inPlane)) : ends;
}

}  // namespace

FeatureGeometry::FeatureGeometry(const TriangleMesh& mesh, const MeshFeatures& features,
                                 std::span<const glm::dvec3> positions)
    : mesh_(mesh),
      features_(features),
      x_(positions),
      edgeBase_(static_cast<std::uint32_t>(features.vertices.size())),
      faceBase_(static_cast<std::uint32_t>(features.vertices.size() + features.edges.size())) {}

FeatureGeometry::Corners FeatureGeometry::corners(std::uint32_t feature) const noexcept {
  if (feature < edgeBase_) return {{x_[features_.vertices[feature].vertex]}, 1};
  if (feature < faceBase_) {
    const MeshEdge& e = mesh_.edges()[features_.edges[feature - edgeBase_].edge];
    return {{x_[e.v0], x_[e.v1]}, 2};
  }
  const Triangle& t = mesh_.triangles()[features_.faces[feature - faceBase_].face];
  return {{x_[t[0]], x_[t[1]], x_[t[2]]}, 3};
}

const NormalCone& FeatureGeometry::cone(std::uint32_t feature) const noexcept {
  if (feature < edgeBase_) return features_.vertices[feature].cone;
  if (feature < faceBase_) return features_.edges[feature - edgeBase_].cone;
  return features_.faces[feature - faceBase_].cone;
}

double FeatureGeometry::support(std::uint32_t feature, const glm::dvec3& direction) const noexcept {
  if (feature < edgeBase_) return vertexSupport(features_.vertices[feature], direction);
  if (feature < faceBase_) return edgeSupport(features_.edges[feature - edgeBase_], direction);
  return glm::dot(features_.faces[feature - faceBase_].cone.axis, direction);
}

double FeatureGeometry::edgeSupport(const EdgeFeature& e, const glm::dvec3& w) const noexcept {
  const MeshEdge& edge = mesh_.edges()[e.edge];
  const glm::dvec3 along = glm::normalize(x_[edge.v1] - x_[edge.v0]);
  // The polar arc is perpendicular to the edge and reaches the half-angle to either side of the cone's axis.
  const glm::dvec3 inPlane = w - glm::dot(w, along) * along;
  const double length = glm::length(inPlane);
  if (!(length > 0.0)) return 0.0;
  return length * coneSupport(e.cone, inPlane / length);
}

void FeatureGeometry::rays(std::uint32_t feature, Rays& out) const noexcept {
  const NormalCone& axis = cone(feature);
  bool isSpanned = true;
  out.count = 0;
  if (feature < edgeBase_) {
    isSpanned = raysOfVertex(features_.vertices[feature], out);
  } else if (feature < faceBase_) {
    raysOfEdge(features_.edges[feature - edgeBase_], out);
  } else {
    out.rays[out.count++] = axis.axis;
  }
  // d is a sum of unit rays r with weights w >= 0. With axis a, d.a <= 1 and d.a >= min(r.a) * sum(w); and
  // sum(w) >= |d|.
  double least = 1.0;
  for (std::size_t i = 0; i < out.count; ++i)
    least = std::min(least, glm::dot(out.rays[i], axis.axis));
  out.stretch = isSpanned && least > 0.0 ? 1.0 / least : std::numeric_limits<double>::infinity();
  if (!isSpanned) {
    out.count = 1;
    out.rays[0] = axis.axis;
  }
}

/// Rays of an edge: the ends of its polar arc.
void FeatureGeometry::raysOfEdge(const EdgeFeature& e, Rays& out) const noexcept {
  const MeshEdge& edge = mesh_.edges()[e.edge];
  const glm::dvec3 across = glm::normalize(glm::cross(x_[edge.v1] - x_[edge.v0], e.cone.axis));
  const double cosine = std::cos(e.cone.halfAngle), sine = std::sin(e.cone.halfAngle);
  out.rays[out.count++] = cosine * e.cone.axis + sine * across;
  out.rays[out.count++] = cosine * e.cone.axis - sine * across;
}

/// Rays of a vertex: the extreme rays of its polar cone, each perpendicular to two neighbouring edges. False
/// if they cannot be determined.
bool FeatureGeometry::raysOfVertex(const VertexFeature& v, Rays& out) const noexcept {
  const std::span<const std::uint32_t> neighbours =
      std::span(features_.neighbours).subspan(v.firstNeighbour, v.hullCount);
  // Fewer than three walls form a wedge, which has no extreme rays.
  if (neighbours.size() < 3 || neighbours.size() > kMaxRays) return false;
  const glm::dvec3& x = x_[v.vertex];
  glm::dvec3 previous = x_[neighbours.back()] - x;
  for (const std::uint32_t neighbour : neighbours) {
    const glm::dvec3 e = x_[neighbour] - x;
    const glm::dvec3 ray = glm::cross(previous, e);
    const double length = glm::length(ray);
    if (!(length > 0.0)) return false;
    // Extreme rays lie within a right angle of the cone's axis; near that angle their sign is uncertain.
    const double side = glm::dot(ray, v.cone.axis) / length;
    if (std::abs(side) < 1e-3) return false;
    out.rays[out.count++] = ray / (side < 0.0 ? -length : length);
    previous = e;
  }
  return true;
}

double FeatureGeometry::vertexSupport(const VertexFeature& v, const glm::dvec3& w) const noexcept {
  const double byCone = coneSupport(v.cone, w);
  Rays walls;
  if (!raysOfVertex(v, walls)) return byCone;
  bool isInside = true;
  const glm::dvec3& x = x_[v.vertex];
  for (std::uint32_t i = 0; i < v.neighbourCount; ++i) {
    isInside = isInside && glm::dot(w, x_[features_.neighbours[v.firstNeighbour + i]] - x) <= 0.0;
  }
  if (isInside) return 1.0;
  double most = -1.0;
  for (std::size_t i = 0; i < walls.count; ++i) {
    most = std::max(most, arcSupport(walls.rays[i], walls.rays[(i + 1) % walls.count], w));
  }
  return std::min(most, byCone);
}

}  // namespace nearfit
