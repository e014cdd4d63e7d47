#include "core/proximity/feature_geometry.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// Largest cosine between w and the directions within a cone.
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
  // The polar arc lies across the edge, half-angle either side of its axis.
  const glm::dvec3 inPlane = w - glm::dot(w, along) * along;
  const double length = glm::length(inPlane);
  if (!(length > 0.0)) return 0.0;
  return length * coneSupport(e.cone, inPlane / length);
}

double FeatureGeometry::vertexSupport(const VertexFeature& v, const glm::dvec3& w) const noexcept {
  const double byCone = coneSupport(v.cone, w);
  const std::span<const std::uint32_t> neighbours =
      std::span(features_.neighbours).subspan(v.firstNeighbour, v.neighbourCount);
  // A wedge has no apex to walk around; of a thousand walls the cone says enough.
  constexpr std::size_t kManyWalls = 32;
  if (neighbours.size() < 3 || neighbours.size() > kManyWalls) return byCone;
  const glm::dvec3& x = x_[v.vertex];
  bool isInside = true;
  std::array<glm::dvec3, kManyWalls> rays;
  glm::dvec3 previous = x_[neighbours.back()] - x;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    const glm::dvec3 e = x_[neighbours[i]] - x;
    isInside = isInside && glm::dot(w, e) <= 0.0;
    const glm::dvec3 ray = glm::cross(previous, e);
    const double length = glm::length(ray);
    if (!(length > 0.0)) return byCone;
    // Extreme rays lie within a right angle of the cone's axis; nearly square to it the sign is not sure.
    const double side = glm::dot(ray, v.cone.axis) / length;
    if (std::abs(side) < 1e-3) return byCone;
    rays[i] = ray / (side < 0.0 ? -length : length);
    previous = e;
  }
  if (isInside) return 1.0;
  double most = -1.0;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    most = std::max(most, arcSupport(rays[i], rays[(i + 1) % neighbours.size()], w));
  }
  return std::min(most, byCone);
}

}  // namespace nearfit
