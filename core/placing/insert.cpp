#include "core/placing/insert.h"

#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "core/placing/mesh_region.h"

namespace nearfit {
namespace {

/// Max sine of the angle between a circle's axis and the normal of a face in its plane. Rounding in a file of floats
/// leans either by far less, and no usual chamfer is so flat.
constexpr double kMaxSeatLean = 1e-2;

/// The edge between two vertices; std::nullopt if there is none.
std::optional<std::uint32_t> edgeBetween(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b) {
  for (const std::uint32_t edge : mesh.edgesOfVertex(a)) {
    const MeshEdge& e = mesh.edges()[edge];
    if ((e.v0 == a ? e.v1 : e.v0) == b) return edge;
  }
  return std::nullopt;
}

/// 1 or -1 if a triangle lies across the axis and looks along it or against it; otherwise 0.
int sideOf(const TriangleMesh& mesh, std::uint32_t triangle, const glm::dvec3& axis) {
  const glm::dvec3 normal = triangleNormal(mesh, triangle);
  const double along = glm::dot(normal, axis);
  if (along == 0.0 || glm::length(glm::cross(normal, axis)) > kMaxSeatLean) return 0;
  return along > 0.0 ? 1 : -1;
}

/// The way along a circle's axis that the flat face in its plane looks: 1 or -1; 0 if there is none along most of the
/// edge, or one on either side.
int seatOf(const TriangleMesh& mesh, const PickedFeature& picked) {
  int edges = 0, along = 0, against = 0;
  for (std::size_t i = 1; i < picked.vertices.size(); ++i) {
    const std::optional<std::uint32_t> edge = edgeBetween(mesh, picked.vertices[i - 1], picked.vertices[i]);
    if (!edge) continue;
    ++edges;
    for (const std::uint32_t face : mesh.facesOfEdge(*edge)) {
      const int side = sideOf(mesh, face, picked.feature.direction);
      if (side > 0) ++along;
      if (side < 0) ++against;
    }
  }
  if (2 * std::abs(along - against) <= edges) return 0;
  return along > against ? 1 : -1;
}

AlignFeature asPlane(const AlignFeature& circle) {
  return {FeatureShape::Plane, circle.point, circle.direction};
}

}  // namespace

AlignFeature insertFeature(const TriangleMesh& mesh, const PickedFeature& picked) {
  AlignFeature feature = picked.feature;
  const int seat = feature.shape == FeatureShape::Circle ? seatOf(mesh, picked) : 0;
  if (seat == 0)
    feature.shape = FeatureShape::Axis;
  else
    feature.direction *= static_cast<double>(seat);
  return feature;
}

bool canBeSeated(FeatureShape moving, FeatureShape fixed) noexcept {
  return moving == FeatureShape::Circle && fixed == FeatureShape::Circle;
}

RigidTransform insertMotion(const AlignFeature& moving, const AlignFeature& fixed,
                            const AlignOptions& options) {
  if (!canBeSeated(moving.shape, fixed.shape)) return alignMotion(moving, fixed, options);
  // Flush first; what is left between the centres lies in the plane.
  RigidTransform motion = alignMotion(asPlane(moving), asPlane(fixed), options);
  const glm::dvec3 between = fixed.point - motion.applyToPoint(moving.point);
  motion.translation += between - glm::dot(between, fixed.direction) * fixed.direction;
  return motion;
}

}  // namespace nearfit
