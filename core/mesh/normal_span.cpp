#include "core/mesh/normal_span.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include <glm/geometric.hpp>

#include "core/math/extreme_directions.h"
#include "core/math/min_norm_point.h"
#include "core/math/tolerances.h"

namespace nearfit {
namespace {

/// Normals that differ by less are equal [rad]: a wall between them would have a random direction.
constexpr double kSameNormal = 1e-7;

/// Widening of cones to allow for that [rad].
constexpr double kConePadding = 1e-6;

/// Approximate share of the time spent finding faces and edges.
constexpr double kExactShare = 0.7;

/// Faces around each vertex, in one array.
struct FacesOfVertices {
  std::vector<std::uint32_t> first, face;  ///< `first` has one more entry than there are vertices.

  FacesOfVertices(const TriangleMesh& mesh, std::span<const FaceFeature> faces)
      : first(mesh.vertices().size() + 1, 0), face(3 * faces.size()) {
    for (const FaceFeature& f : faces) {
      for (const std::uint32_t v : mesh.triangles()[f.face])
        ++first[v + 1];
    }
    for (std::size_t v = 1; v < first.size(); ++v)
      first[v] += first[v - 1];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
      for (const std::uint32_t v : mesh.triangles()[faces[i].face])
        face[next[v]++] = i;
    }
  }

  std::span<const std::uint32_t> of(std::uint32_t vertex) const {
    return std::span(face).subspan(first[vertex], first[vertex + 1] - first[vertex]);
  }
};

std::vector<glm::dvec3> differentNormals(std::span<const FaceFeature> faces,
                                         std::span<const std::uint32_t> around) {
  std::vector<glm::dvec3> normals;
  for (const std::uint32_t f : around) {
    const glm::dvec3& n = faces[f].cone.axis;
    const bool isNew = std::ranges::none_of(
        normals, [&](const glm::dvec3& other) { return glm::distance(n, other) < kSameNormal; });
    if (isNew) normals.push_back(n);
  }
  return normals;
}

/// Convex cone spanned by normals.
struct Span {
  std::vector<glm::dvec3> walls;  ///< Unit; empty if the normals span everything.
  NormalCone bound;
};

/// std::nullopt if the span has no interior.
std::optional<Span> spanOf(std::span<const glm::dvec3> normals) {
  if (normals.size() < 3) return std::nullopt;
  const glm::dvec3 nearest = minNormPoint(normals);
  const double width = glm::length(nearest);
  // Normals all around: their span excludes no direction.
  if (!(width > kSameNormal)) return Span{};
  const glm::dvec3 axis = nearest / width;
  const std::vector<std::size_t> extreme = extremeDirections(normals, axis);
  if (extreme.size() < 3) return std::nullopt;
  Span span;
  std::vector<NormalCone> rays;
  for (std::size_t i = 0; i < extreme.size(); ++i) {
    const glm::dvec3 &a = normals[extreme[i]], &b = normals[extreme[(i + 1) % extreme.size()]];
    span.walls.push_back(glm::normalize(glm::cross(a, b)));
    rays.push_back({a, 0.0});
  }
  // All normals are within a right angle of the axis. So the cone of half-angle pi/2 about it is convex and
  // contains their span; so does a narrower bounding cone, being convex too.
  const NormalCone aboutAll = boundingCone(rays);
  span.bound =
      aboutAll.halfAngle < 0.5 * std::numbers::pi ? aboutAll : NormalCone{axis, 0.5 * std::numbers::pi};
  span.bound.halfAngle = std::min(span.bound.halfAngle + kConePadding, std::numbers::pi);
  return span;
}

void addVertex(std::uint32_t vertex, std::span<const std::uint32_t> around, const TriangleMesh& mesh,
               NormalSpanFeatures& out) {
  const auto span = spanOf(differentNormals(out.features.faces, around));
  if (!span) return;
  MeshFeatures& features = out.features;
  const auto first = static_cast<std::uint32_t>(features.neighbours.size());
  features.vertices.push_back({vertex, first, 2 * static_cast<std::uint32_t>(around.size()), 0, span->bound});
  for (std::size_t i = 0; i < around.size(); ++i) {
    for (const std::uint32_t corner : mesh.triangles()[features.faces[around[i]].face]) {
      if (corner != vertex) features.neighbours.push_back(corner);
    }
    out.walls.push_back(i < span->walls.size() ? span->walls[i] : glm::dvec3(0.0));
  }
}

}  // namespace

NormalSpanFeatures findNormalSpanFeatures(const TriangleMesh& mesh,
                                          const std::function<void(double)>& onProgress) {
  NormalSpanFeatures out;
  MeshFeatures exact = findFeatures(mesh, [&](double done) {
    if (onProgress) onProgress(kExactShare * done);
  });
  out.features.faces = std::move(exact.faces);
  std::ranges::copy_if(exact.edges, std::back_inserter(out.features.edges), [&](const EdgeFeature& e) {
    return mesh.facesOfEdge(e.edge).size() == 2 && mesh.isEdgeConsistent(e.edge);
  });
  const FacesOfVertices around(mesh, out.features.faces);
  for (std::uint32_t v = 0; v < mesh.vertices().size(); ++v)
    addVertex(v, around.of(v), mesh, out);
  if (onProgress) onProgress(1.0);
  return out;
}

}  // namespace nearfit
