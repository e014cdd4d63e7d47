#include "core/placing/feature_pick.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/placing/circle_fit.h"
#include "core/placing/exact_faces.h"
#include "core/placing/mesh_region.h"
#include "core/placing/round_corners.h"

namespace nearfit {
namespace {

/// The edges of a shape: sharp ones, or those that its exact surfaces say.
struct ShapeEdges {
  const TriangleMesh& mesh;
  const ExactFaces* exact;  ///< Null if no surfaces are known.

  bool contain(std::uint32_t edge) const {
    return exact != nullptr ? exact->isEdge(edge) : isSharp(mesh, edge);
  }
};

/// Consecutive edges of the shape on one circle or line.
struct EdgeChain {
  /// In order; if closed, the first is repeated at the end.
  std::vector<std::uint32_t> vertices;
  bool isRound = false;
  /// The circle of a round chain. For a line: centre at its middle, axis along it, radius 0.
  Circle circle;
};

/// Max distance of corners from a circle, as a fraction of its radius, and from a line, as a
/// fraction of the mesh.
constexpr double kOffCircle = 2e-3, kOffLine = 2e-6;
constexpr std::size_t kFewestCorners = 5;

using Chain = std::deque<std::uint32_t>;

/// Far ends of the edges that continue a chain at `at`, coming from `from`.
std::vector<std::uint32_t> nextOf(const ShapeEdges& edges, std::uint32_t at, std::uint32_t from) {
  std::vector<std::uint32_t> next;
  for (const std::uint32_t edge : edges.mesh.edgesOfVertex(at)) {
    const MeshEdge& e = edges.mesh.edges()[edge];
    const std::uint32_t other = e.v0 == at ? e.v1 : e.v0;
    if (other != from && edges.contain(edge)) next.push_back(other);
  }
  return next;
}

/// Extends a chain at its end while a fitting corner follows. True if that closes it.
/// @param maxTurn  From an edge to the next [rad].
template <class Fits>
bool lengthen(const ShapeEdges& edges, Chain& chain, double maxTurn, Fits&& fits) {
  const TriangleMesh& mesh = edges.mesh;
  for (;;) {
    const std::uint32_t at = chain.back(), from = chain[chain.size() - 2];
    const glm::dvec3 along = mesh.vertices()[at] - mesh.vertices()[from];
    bool hasGrown = false;
    for (const std::uint32_t next : nextOf(edges, at, from)) {
      const glm::dvec3 on = mesh.vertices()[next] - mesh.vertices()[at];
      const double turn = std::atan2(glm::length(glm::cross(along, on)), glm::dot(along, on));
      if (turn > maxTurn + 1e-3 || !fits(mesh.vertices()[next])) continue;
      if (next == chain.front()) return true;
      chain.push_back(next);
      hasGrown = true;
      break;
    }
    // More corners than vertices: it would run in circles.
    if (!hasGrown || chain.size() > mesh.vertices().size()) return false;
  }
}

template <class Fits>
Chain chainOf(const ShapeEdges& edges, const MeshEdge& edge, double maxTurn, Fits&& fits) {
  Chain chain{edge.v0, edge.v1};
  if (lengthen(edges, chain, maxTurn, fits)) {
    chain.push_back(chain.front());
    return chain;
  }
  std::reverse(chain.begin(), chain.end());
  lengthen(edges, chain, maxTurn, fits);
  return chain;
}

std::vector<glm::dvec3> pointsOf(const TriangleMesh& mesh, const Chain& chain) {
  std::vector<glm::dvec3> points;
  const bool isClosed = chain.size() > 2 && chain.front() == chain.back();
  for (std::size_t i = isClosed ? 1 : 0; i < chain.size(); ++i)
    points.push_back(mesh.vertices()[chain[i]]);
  return points;
}

EdgeChain straightChain(const ShapeEdges& edges, const MeshEdge& edge) {
  const TriangleMesh& mesh = edges.mesh;
  const glm::dvec3 point = mesh.vertices()[edge.v0];
  const glm::dvec3 along = glm::normalize(mesh.vertices()[edge.v1] - point);
  const double slack = kOffLine * mesh.bounds().diagonal();
  const Chain chain = chainOf(edges, edge, kSharpTurn, [&](const glm::dvec3& p) {
    return glm::length(glm::cross(p - point, along)) <= slack;
  });
  EdgeChain result;
  result.vertices.assign(chain.begin(), chain.end());
  const glm::dvec3 first = mesh.vertices()[chain.front()], last = mesh.vertices()[chain.back()];
  result.circle = {0.5 * (first + last), glm::normalize(last - first), 0.0};
  return result;
}

/// The round chain through an edge and a corner adjacent to one of its ends.
std::optional<EdgeChain> roundChain(const ShapeEdges& edges, const MeshEdge& edge, std::uint32_t beyond,
                                    double maxTurn) {
  const TriangleMesh& mesh = edges.mesh;
  const glm::dvec3 three[] = {mesh.vertices()[edge.v0], mesh.vertices()[edge.v1], mesh.vertices()[beyond]};
  std::optional<Circle> circle = fitCircle(three);
  if (!circle) return std::nullopt;
  EdgeChain result;
  // Fit again with all corners: three close ones determine the circle poorly.
  for (int round = 0; round < 2; ++round) {
    const double slack = (round == 0 ? 5.0 : 1.0) * kOffCircle * circle->radius;
    const Chain chain =
        chainOf(edges, edge, maxTurn, [&](const glm::dvec3& p) { return circle->distanceFrom(p) <= slack; });
    if (chain.size() < kFewestCorners) return std::nullopt;
    circle = fitCircle(pointsOf(mesh, chain));
    if (!circle) return std::nullopt;
    result.vertices.assign(chain.begin(), chain.end());
  }
  for (const std::uint32_t v : result.vertices) {
    if (circle->distanceFrom(mesh.vertices()[v]) > kOffCircle * circle->radius) return std::nullopt;
  }
  result.isRound = true;
  result.circle = *circle;
  return result;
}

/// The longest round chain through an edge.
std::optional<EdgeChain> roundChain(const ShapeEdges& edges, const MeshEdge& edge, double maxTurn) {
  std::optional<EdgeChain> best;
  for (const auto& [at, from] : {std::pair(edge.v1, edge.v0), std::pair(edge.v0, edge.v1)}) {
    for (const std::uint32_t beyond : nextOf(edges, at, from)) {
      std::optional<EdgeChain> found = roundChain(edges, edge, beyond, maxTurn);
      if (found && (!best || found->vertices.size() > best->vertices.size())) best = std::move(found);
    }
  }
  return best;
}

/// True if a chain is a whole circle, of as many corners as the ring of a wall has at least.
bool isCoarseCircle(const EdgeChain& chain) {
  return chain.vertices.front() == chain.vertices.back() && chain.vertices.size() > kRoundRing.fewestFacets;
}

/// The chain that contains an edge of the shape: the whole circle or arc if it has at least five corners, a coarse
/// circle, else the straight edge. O(n) in the chain.
EdgeChain edgeChain(const ShapeEdges& edges, std::uint32_t ofShape) {
  const MeshEdge& edge = edges.mesh.edges()[ofShape];
  if (auto fine = roundChain(edges, edge, kSharpTurn)) return *std::move(fine);
  auto coarse = roundChain(edges, edge, kRoundRing.widestFacet);
  return coarse && isCoarseCircle(*coarse) ? *std::move(coarse) : straightChain(edges, edge);
}

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
bool isCorner(const ShapeEdges& edges, std::uint32_t vertex) {
  const TriangleMesh& mesh = edges.mesh;
  std::vector<std::uint32_t> ofShape;
  std::ranges::copy_if(mesh.edgesOfVertex(vertex), std::back_inserter(ofShape),
                       [&](std::uint32_t edge) { return edges.contain(edge); });
  if (edges.exact != nullptr) return edges.exact->isCorner(vertex, ofShape);
  if (ofShape.size() != 2) return !ofShape.empty();
  const auto wayAlong = [&](std::uint32_t edge) {
    const MeshEdge& e = mesh.edges()[edge];
    const std::uint32_t other = e.v0 == vertex ? e.v1 : e.v0;
    return glm::normalize(mesh.vertices()[other] - mesh.vertices()[vertex]);
  };
  return glm::dot(wayAlong(ofShape[0]), -wayAlong(ofShape[1])) < std::cos(kSharpTurn);
}

class Pick {
 public:
  /// @param exact  Null if no surfaces are known.
  Pick(const TriangleMesh& mesh, const SurfaceHit& hit, double reach, const ExactFaces* exact)
      : mesh_(mesh),
        hit_(hit),
        reach_(reach),
        exact_(exact),
        edges_{mesh, exact},
        around_(trianglesAround(mesh, hit, reach)) {}

  std::optional<PickedFeature> corner() const {
    double nearest = reach_;
    std::optional<std::uint32_t> found;
    for (const std::uint32_t t : around_) {
      for (const std::uint32_t v : mesh_.triangles()[t]) {
        const double distance = glm::distance(mesh_.vertices()[v], hit_.point);
        if (!(distance <= nearest) || !isCorner(edges_, v)) continue;
        nearest = distance;
        found = v;
      }
    }
    if (!found) return std::nullopt;
    return PickedFeature{{FeatureShape::Point, mesh_.vertices()[*found]}, {}, {*found}};
  }

  /// The edge of the shape nearest to the point.
  std::optional<std::uint32_t> nearestEdge() const {
    double nearest = reach_;
    std::optional<std::uint32_t> found;
    for (const std::uint32_t t : around_) {
      for (const std::uint32_t e : mesh_.edgesOfTriangle(t)) {
        const double distance = distanceToEdge(mesh_, e, hit_.point);
        if (!(distance <= nearest) || !edges_.contain(e)) continue;
        nearest = distance;
        found = e;
      }
    }
    return found;
  }

  /// The edge or circle that an edge of the shape is of.
  PickedFeature edgeAt(std::uint32_t ofShape) const {
    if (exact_ != nullptr) {
      if (auto found = exact_->edgeAt(ofShape)) return *std::move(found);
    }
    EdgeChain chain = edgeChain(edges_, ofShape);
    const FeatureShape shape = chain.isRound ? FeatureShape::Circle : FeatureShape::Axis;
    return {
        {shape, chain.circle.centre, chain.circle.axis, chain.circle.radius}, {}, std::move(chain.vertices)};
  }

  std::optional<PickedFeature> edge() const {
    const std::optional<std::uint32_t> found = nearestEdge();
    return found ? std::optional(edgeAt(*found)) : std::nullopt;
  }

  /// The nearest edge or circle, or the cylinder or cone around the point: the latter too where an edge only parts
  /// two facets of it.
  std::optional<PickedFeature> edgeOrWall() const {
    const std::optional<std::uint32_t> nearest = nearestEdge();
    std::optional<PickedFeature> edge = nearest ? std::optional(edgeAt(*nearest)) : std::nullopt;
    if (edge && edge->feature.shape == FeatureShape::Circle) return edge;
    std::optional<PickedFeature> found = wall();
    if (!edge) return found;
    return found && isInside(*nearest, found->triangles) ? found : edge;
  }

  /// The nearest edge if it is round, or the cylinder or cone around the point.
  std::optional<PickedFeature> circleOrWall() const {
    std::optional<PickedFeature> nearest = edge();
    return nearest && nearest->feature.shape == FeatureShape::Circle ? nearest : wall();
  }

  std::optional<PickedFeature> wall() const {
    if (isKnown()) return exact_->wall(hit_.triangle);
    std::optional<CylinderRegion> cylinder = cylinderRegion(mesh_, hit_.triangle);
    std::optional<ConeRegion> cone;
    // An arc may be a piece of a cone that is more than that.
    if (!cylinder || !cylinder->isRing) cone = coneRegion(mesh_, hit_.triangle);
    if (cone && (!cylinder || cone->triangles.size() > cylinder->triangles.size()))
      return wallOf(std::move(*cone));
    if (!cylinder) return std::nullopt;
    const Circle& c = cylinder->cylinder;
    return PickedFeature{
        {FeatureShape::Axis, c.centre, c.axis, c.radius}, std::move(cylinder->triangles), {}};
  }

  /// The centre of the sphere that the point is on.
  std::optional<PickedFeature> sphere() const {
    return isKnown() ? exact_->sphere(hit_.triangle) : std::nullopt;
  }

  /// The prism that the point is on a flat of.
  std::optional<PickedFeature> prism() const {
    if (isKnown() && !exact_->plane(hit_.triangle)) return std::nullopt;
    std::optional<ConeRegion> region = coneRegion(mesh_, hit_.triangle, true);
    if (!region) return std::nullopt;
    const auto flats = static_cast<std::uint32_t>(region->facets);
    PickedFeature picked = wallOf(std::move(*region));
    picked.feature.flats = flats;
    return picked;
  }

  std::optional<PickedFeature> face() const {
    if (isKnown()) return exact_->plane(hit_.triangle);
    PlaneRegion region = planeRegion(mesh_, hit_.triangle);
    if (region.triangles.empty()) return std::nullopt;
    return PickedFeature{{FeatureShape::Plane, region.point, region.normal}, std::move(region.triangles), {}};
  }

  PickedFeature point() const { return {{FeatureShape::Point, hit_.point}, {}, {}}; }

 private:
  /// True if the exact surface under the point is known.
  bool isKnown() const {
    return exact_ != nullptr && exact_->surfaceOf(hit_.triangle).kind != SurfaceKind::Other;
  }
  static PickedFeature wallOf(ConeRegion&& region) {
    const Cone& c = region.cone;
    return {{FeatureShape::Axis, c.centre, c.axis, c.radius, c.halfAngle()}, std::move(region.triangles), {}};
  }
  bool isInside(std::uint32_t edge, const std::vector<std::uint32_t>& triangles) const {
    return std::ranges::all_of(mesh_.facesOfEdge(edge), [&](std::uint32_t face) {
      return std::ranges::find(triangles, face) != triangles.end();
    });
  }

  const TriangleMesh& mesh_;
  const SurfaceHit& hit_;
  double reach_;
  const ExactFaces* exact_;
  ShapeEdges edges_;
  std::vector<std::uint32_t> around_;
};

std::optional<PickedFeature> pickPoint(const Pick& pick) {
  if (auto corner = pick.corner()) return corner;
  std::optional<PickedFeature> edge = pick.edge();
  if (!edge || edge->feature.shape != FeatureShape::Circle) {
    std::optional<PickedFeature> centre = pick.sphere();
    return centre ? centre : pick.point();
  }
  edge->feature.shape = FeatureShape::Point;
  edge->feature.direction = glm::dvec3(0.0);
  return edge;
}

}  // namespace

std::optional<PickedFeature> pickFeature(const TriangleMesh& mesh, const SurfaceHit& hit, double reach,
                                         FeatureFilter filter, const SurfaceFaces* surfaces) {
  std::optional<ExactFaces> exact;
  // Faces that only tell colours apart know of no edges.
  const auto isKnown = [](const ExactSurface& surface) { return surface.kind != SurfaceKind::Other; };
  if (surfaces != nullptr && std::ranges::any_of(surfaces->faces, isKnown)) exact.emplace(mesh, *surfaces);
  const Pick pick(mesh, hit, reach, exact ? &*exact : nullptr);
  if (filter == FeatureFilter::Points) return pickPoint(pick);
  if (filter == FeatureFilter::Faces) return pick.face();
  const bool isAny = filter == FeatureFilter::Any;
  if (isAny) {
    if (auto corner = pick.corner()) return corner;
  }
  if (auto found = filter == FeatureFilter::Rounds ? pick.circleOrWall() : pick.edgeOrWall()) return found;
  if (filter == FeatureFilter::Axes) return pick.prism();
  if (!isAny) return std::nullopt;
  std::optional<PickedFeature> ball = pick.sphere();
  return ball ? ball : pick.face();
}

std::optional<PickedFeature> pickFeature(const MeshSection& section, glm::dvec3& point, double reach,
                                         FeatureFilter filter) {
  if (filter == FeatureFilter::Faces || filter == FeatureFilter::Rounds) return std::nullopt;
  const PickedFeature veryPoint{{FeatureShape::Point, point}, {}, {}};
  if (filter == FeatureFilter::Points) return veryPoint;
  PickedFeature edge;
  double nearest = reach;
  for (const auto& [from, to] : section.outline) {
    const glm::dvec3 a = section.points[from], along = section.points[to] - a;
    const double squared = glm::dot(along, along);
    if (!(squared > 0.0)) continue;
    const glm::dvec3 on =
        a + std::clamp(glm::dot(veryPoint.feature.point - a, along) / squared, 0.0, 1.0) * along;
    const double distance = glm::distance(on, veryPoint.feature.point);
    if (!(distance <= nearest)) continue;
    nearest = distance;
    point = on;
    edge.feature = {FeatureShape::Axis, on, glm::normalize(along)};
  }
  if (edge.feature.shape == FeatureShape::Axis) return edge;
  return filter == FeatureFilter::Any ? std::optional(veryPoint) : std::nullopt;
}

}  // namespace nearfit
