#include "core/placing/feature_pick.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/placing/edge_chain.h"
#include "core/placing/mesh_region.h"
#include "core/placing/region_growth.h"

namespace nearfit {
namespace {

/// Max number of triangles around the point to search for corners and edges.
constexpr std::size_t kMaxAround = 400;

double distanceToEdge(const TriangleMesh& mesh, std::uint32_t edge, const glm::dvec3& point) {
  const MeshEdge& e = mesh.edges()[edge];
  const glm::dvec3 a = mesh.vertices()[e.v0], along = mesh.vertices()[e.v1] - a;
  const double share = std::clamp(glm::dot(point - a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::distance(point, a + share * along);
}

/// Triangles within reach of the point that are connected to the hit one.
std::vector<std::uint32_t> trianglesAround(const TriangleMesh& mesh, const SurfaceHit& hit, double reach) {
  const auto isNear = [&](std::uint32_t triangle) {
    const auto& edges = mesh.edgesOfTriangle(triangle);
    return std::any_of(edges.begin(), edges.end(),
                       [&](std::uint32_t edge) { return distanceToEdge(mesh, edge, hit.point) <= reach; });
  };
  return grownRegion(mesh, hit.triangle, isNear, kMaxAround);
}

/// True for a corner of the shape, not just of the triangulation.
bool isCorner(const TriangleMesh& mesh, std::uint32_t vertex) {
  std::vector<glm::dvec3> sharp;
  for (const std::uint32_t edge : mesh.edgesOfVertex(vertex)) {
    if (!isSharp(mesh, edge)) continue;
    const MeshEdge& e = mesh.edges()[edge];
    const std::uint32_t other = e.v0 == vertex ? e.v1 : e.v0;
    sharp.push_back(glm::normalize(mesh.vertices()[other] - mesh.vertices()[vertex]));
  }
  if (sharp.size() != 2) return !sharp.empty();
  return glm::dot(sharp[0], -sharp[1]) < std::cos(kSharpTurn);
}

class Pick {
 public:
  Pick(const TriangleMesh& mesh, const SurfaceHit& hit, double reach)
      : mesh_(mesh), hit_(hit), reach_(reach), around_(trianglesAround(mesh, hit, reach)) {}

  std::optional<PickedFeature> corner() const {
    double nearest = reach_;
    std::optional<std::uint32_t> found;
    for (const std::uint32_t t : around_) {
      for (const std::uint32_t v : mesh_.triangles()[t]) {
        const double distance = glm::distance(mesh_.vertices()[v], hit_.point);
        if (!(distance <= nearest) || !isCorner(mesh_, v)) continue;
        nearest = distance;
        found = v;
      }
    }
    if (!found) return std::nullopt;
    return PickedFeature{{FeatureShape::Point, mesh_.vertices()[*found]}, {}, {*found}};
  }

  std::optional<PickedFeature> edge() const {
    double nearest = reach_;
    std::optional<std::uint32_t> found;
    for (const std::uint32_t t : around_) {
      for (const std::uint32_t e : mesh_.edgesOfTriangle(t)) {
        const double distance = distanceToEdge(mesh_, e, hit_.point);
        if (!(distance <= nearest) || !isSharp(mesh_, e)) continue;
        nearest = distance;
        found = e;
      }
    }
    if (!found) return std::nullopt;
    EdgeChain chain = edgeChain(mesh_, *found);
    const FeatureShape shape = chain.isRound ? FeatureShape::Circle : FeatureShape::Axis;
    return PickedFeature{
        {shape, chain.circle.centre, chain.circle.axis, chain.circle.radius}, {}, std::move(chain.vertices)};
  }

  std::optional<PickedFeature> cylinder() const {
    std::optional<CylinderRegion> region = cylinderRegion(mesh_, hit_.triangle);
    if (!region) return std::nullopt;
    const Circle& c = region->cylinder;
    return PickedFeature{{FeatureShape::Axis, c.centre, c.axis, c.radius}, std::move(region->triangles), {}};
  }

  std::optional<PickedFeature> face() const {
    PlaneRegion region = planeRegion(mesh_, hit_.triangle);
    if (region.triangles.empty()) return std::nullopt;
    return PickedFeature{{FeatureShape::Plane, region.point, region.normal}, std::move(region.triangles), {}};
  }

  PickedFeature point() const { return {{FeatureShape::Point, hit_.point}, {}, {}}; }

 private:
  const TriangleMesh& mesh_;
  const SurfaceHit& hit_;
  double reach_;
  std::vector<std::uint32_t> around_;
};

std::optional<PickedFeature> pickPoint(const Pick& pick) {
  if (auto corner = pick.corner()) return corner;
  std::optional<PickedFeature> edge = pick.edge();
  if (!edge || edge->feature.shape != FeatureShape::Circle) return pick.point();
  edge->feature.shape = FeatureShape::Point;
  edge->feature.direction = glm::dvec3(0.0);
  return edge;
}

}  // namespace

std::optional<PickedFeature> pickFeature(const TriangleMesh& mesh, const SurfaceHit& hit, double reach,
                                         FeatureFilter filter) {
  const Pick pick(mesh, hit, reach);
  if (filter == FeatureFilter::Points) return pickPoint(pick);
  if (filter == FeatureFilter::Faces) return pick.face();
  if (filter == FeatureFilter::Any) {
    if (auto corner = pick.corner()) return corner;
  }
  if (auto edge = pick.edge()) return edge;
  if (auto cylinder = pick.cylinder()) return cylinder;
  return filter == FeatureFilter::Any ? pick.face() : std::nullopt;
}

}  // namespace nearfit
