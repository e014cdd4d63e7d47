#include "core/verdict/convex_depth.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// Bound on pairs of faces and corners, and of edges: some ten milliseconds.
constexpr std::size_t kMaxConvexPairs = 4'000'000;

/// How far a corner may be in front of a face of a convex body, as a fraction of its size: the rounding of coordinates that
/// were turned. The depth is off by no more.
constexpr double kConvexSlack = 1e-10;

/// Faces whose normals differ by less are in one plane [rad], and their common edge shows itself to nothing.
constexpr double kOnePlaneAngle = 1e-7;

/// Edges nearer to parallel than this have no reliable common normal [rad].
constexpr double kParallelEdges = 1e-12;

bool areAllBehind(const std::vector<glm::dvec3>& corners, const ConvexBody::Face& face, double slack) {
  const double height = glm::dot(face.normal, corners[face.corner]) + slack;
  return std::ranges::all_of(corners,
                             [&](const glm::dvec3& p) { return glm::dot(face.normal, p) <= height; });
}

/// A convex body in the frame of a search.
struct PlacedConvex {
  std::vector<glm::dvec3> corners, normals;
  const ConvexBody& body;

  /// @param origin  Of the search, which keeps coordinates small.
  PlacedConvex(const ConvexBody& b, const RigidTransform& frameFromBody, const glm::dvec3& origin) : body(b) {
    for (const glm::dvec3& p : b.corners)
      corners.push_back(frameFromBody.applyToPoint(p) - origin);
    for (const ConvexBody::Face& face : b.faces)
      normals.push_back(frameFromBody.applyToVector(face.normal));
  }
  double highest(const glm::dvec3& direction) const {
    double most = -std::numeric_limits<double>::infinity();
    for (const glm::dvec3& p : corners)
      most = std::max(most, glm::dot(direction, p));
    return most;
  }
};

class LeastTranslation {
 public:
  void offer(double length, const glm::dvec3& direction) {
    if (length < least_.length) least_ = {length, direction};
  }
  const FreeingTranslation& least() const { return least_; }

 private:
  FreeingTranslation least_{std::numeric_limits<double>::infinity(), {}};
};

/// True if the arcs of normals a-b of one body and c-d of the other one turned round cross: then an edge of each can be
/// all that the two have in common.
bool doArcsCross(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
  const glm::dvec3 ab = glm::cross(b, a), cd = glm::cross(d, c);
  const double cba = glm::dot(c, ab), dba = glm::dot(d, ab), adc = glm::dot(a, cd), bdc = glm::dot(b, cd);
  return cba * dba < 0.0 && adc * bdc < 0.0 && cba * bdc > 0.0;
}

void tryEdges(const PlacedConvex& scene, const PlacedConvex& part, LeastTranslation& least) {
  for (const ConvexBody::Edge& e : scene.body.edges) {
    const glm::dvec3 &a = scene.normals[e.left], &b = scene.normals[e.right];
    const glm::dvec3 from = scene.corners[e.from], side = scene.corners[e.to] - from;
    for (const ConvexBody::Edge& f : part.body.edges) {
      if (!doArcsCross(a, b, -part.normals[f.left], -part.normals[f.right])) continue;
      const glm::dvec3 other = part.corners[f.to] - part.corners[f.from];
      glm::dvec3 normal = glm::cross(side, other);
      const double length = glm::length(normal);
      if (!(length > kParallelEdges * glm::length(side) * glm::length(other))) continue;
      normal /= glm::dot(normal, a + b) < 0.0 ? -length : length;
      least.offer(glm::dot(normal, from - part.corners[f.from]), normal);
    }
  }
}

}  // namespace

std::optional<ConvexBody> convexBodyOf(const TriangleMesh& mesh) {
  const MeshTopology& topology = mesh.topology();
  if (!topology.isClosed() || !topology.isOriented() || topology.components != 1) return std::nullopt;
  if (mesh.triangles().size() * mesh.vertices().size() > kMaxConvexPairs) return std::nullopt;
  ConvexBody body;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> cornerOf(mesh.vertices().size(), kNone);
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t v : t) {
      if (cornerOf[v] != kNone) continue;
      cornerOf[v] = static_cast<std::uint32_t>(body.corners.size());
      body.corners.push_back(mesh.vertices()[v]);
    }
    const glm::dvec3 &a = mesh.vertices()[t[0]], &b = mesh.vertices()[t[1]], &c = mesh.vertices()[t[2]];
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    // Without an area, it has no direction, and neither have its edges as it sees them.
    if (!(length > 0.0)) return std::nullopt;
    body.faces.push_back({normal / length, cornerOf[t[0]]});
  }
  const double slack = kConvexSlack * (mesh.bounds().diagonal() + mesh.bounds().largestCoordinate());
  const bool isConvex = std::ranges::all_of(
      body.faces, [&](const ConvexBody::Face& face) { return areAllBehind(body.corners, face, slack); });
  if (!isConvex || body.faces.empty()) return std::nullopt;
  for (std::uint32_t e = 0; e < mesh.edges().size(); ++e) {
    const auto faces = mesh.facesOfEdge(e);
    const std::uint32_t left = faces[0], right = faces[1];
    if (glm::length(body.faces[left].normal - body.faces[right].normal) < kOnePlaneAngle) continue;
    body.edges.push_back({cornerOf[mesh.edges()[e].v0], cornerOf[mesh.edges()[e].v1], left, right});
  }
  return body;
}

std::optional<FreeingTranslation> convexDepth(const ConvexBody& scene, const ConvexBody& part,
                                              const RigidTransform& sceneFromPart) {
  const std::size_t pairs =
      std::max({scene.edges.size() * part.edges.size(), scene.faces.size() * part.corners.size(),
                part.faces.size() * scene.corners.size()});
  if (pairs > kMaxConvexPairs) return std::nullopt;
  const glm::dvec3 origin = scene.corners.front();
  const PlacedConvex placedScene(scene, {}, origin), placedPart(part, sceneFromPart, origin);
  LeastTranslation least;
  for (std::size_t i = 0; i < scene.faces.size(); ++i) {
    const glm::dvec3& normal = placedScene.normals[i];
    const double height = glm::dot(normal, placedScene.corners[scene.faces[i].corner]);
    least.offer(height + placedPart.highest(-normal), normal);
  }
  for (std::size_t i = 0; i < part.faces.size(); ++i) {
    const glm::dvec3 normal = -placedPart.normals[i];
    const double height = glm::dot(normal, placedPart.corners[part.faces[i].corner]);
    least.offer(placedScene.highest(normal) - height, normal);
  }
  tryEdges(placedScene, placedPart, least);
  return least.least();
}

}  // namespace nearfit
