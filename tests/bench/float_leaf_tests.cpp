#include "tests/bench/float_leaf_tests.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/proximity/query/polygon_clip.h"

namespace nearfit::bench {
namespace {

/// Some seventeen roundings: 1e-10 is a million in double precision.
constexpr float kAngularTolerance = 1e-6F;
/// Parallel to what is left of it over features of a hundredth of the body.
constexpr float kFlatTolerance = 1e-5F;
/// As kPointRounding of tolerances.h: two roundings.
constexpr float kPointRounding = 2e-7F;

glm::vec3 faceNormal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) noexcept {
  return glm::normalize(glm::cross(b - a, c - a));
}

}  // namespace

FloatBody::FloatBody(const NormalConeTree& bodyTree)
    : tree(bodyTree), size(static_cast<float>(bodyTree.size())) {
  for (const glm::dvec3& p : tree.positions())
    positions.emplace_back(p);
}

FloatLeafTests::Motion FloatLeafTests::motionOf(const RigidTransform& pose) noexcept {
  return {glm::mat3(glm::mat3_cast(pose.rotation)), glm::vec3(pose.translation)};
}

FloatLeafTests::FloatLeafTests(const FloatBody& scene, const FloatBody& part,
                               const RigidTransform& sceneFromPart, double cutoff) noexcept
    : sceneFromPart_(motionOf(sceneFromPart)),
      partFromScene_(motionOf(sceneFromPart.inverse())),
      scene_{scene, partFromScene_, sceneFromPart_},
      part_{part, sceneFromPart_, partFromScene_},
      cutoff_(static_cast<float>(cutoff)),
      lengthTolerance_(static_cast<float>(kLengthTolerance) * (scene.size + part.size)),
      pointRounding_(kPointRounding * (scene.size + part.size + glm::length(sceneFromPart_.translation))) {}

float FloatLeafTests::lengthSlack(float distance) const noexcept {
  return lengthTolerance_ + kAngularTolerance * distance;
}

float FloatLeafTests::angularSlack(float distance) const noexcept {
  return kAngularTolerance + pointRounding_ / distance;
}

bool FloatLeafTests::test(std::uint32_t sceneLeaf, std::uint32_t partLeaf, Minimum& out) const noexcept {
  using enum FeatureKind;
  const FeatureKind a = NormalConeTree::leafKind(sceneLeaf), b = NormalConeTree::leafKind(partLeaf);
  const std::uint32_t i = NormalConeTree::leafIndex(sceneLeaf), j = NormalConeTree::leafIndex(partLeaf);
  bool found = false;
  if (a == Vertex && b == Face) found = vertexFace(scene_, i, part_, j, out);
  if (a == Face && b == Vertex) found = vertexFace(part_, j, scene_, i, out);
  if (a == Edge && b == Edge) found = edgeEdge(i, j, out);
  if (a == Vertex && b == Edge) found = vertexEdge(scene_, i, part_, j, out);
  if (a == Edge && b == Vertex) found = vertexEdge(part_, j, scene_, i, out);
  if (a == Vertex && b == Vertex) found = vertexVertex(i, j, out);
  if (a == Edge && b == Face) found = edgeFace(scene_, i, part_, j, out);
  if (a == Face && b == Edge) found = edgeFace(part_, j, scene_, i, out);
  if (a == Face && b == Face) found = faceFace(i, j, out);
  if (!found) return false;
  out.lmd.sceneFeature = a;
  out.lmd.partFeature = b;
  // Unique among features of a kind, which is all that merging asks.
  out.lmd.sceneIndex = i;
  out.lmd.partIndex = j;
  out.lmd.isRegion = out.dimension > 0;
  return true;
}

const glm::vec3& FloatLeafTests::vertexOf(const FloatBody& body, std::uint32_t vertex) noexcept {
  return body.positions[body.tree.vertices()[vertex].vertex];
}

FloatLeafTests::Edge FloatLeafTests::edgeOf(const FloatBody& body, std::uint32_t edge) noexcept {
  const NormalConeTree::EdgeLeaf& leaf = body.tree.edges()[edge];
  const glm::vec3 &a = body.positions[leaf.v0], &b = body.positions[leaf.v1];
  const float length = glm::distance(a, b);
  return {a, (b - a) / length, length};
}

bool FloatLeafTests::isPolarOfVertex(const FloatBody& body, std::uint32_t vertex, const glm::vec3& d,
                                     float slack) const noexcept {
  const NormalConeTree::VertexLeaf& leaf = body.tree.vertices()[vertex];
  const glm::vec3& v = body.positions[leaf.vertex];
  for (const std::uint32_t n : body.tree.neighbours(leaf)) {
    const glm::vec3 e = body.positions[n] - v;
    const float along = glm::dot(d, e);
    if (along > 0.0F && along > slack * glm::length(e) + pointRounding_) return false;
  }
  return true;
}

bool FloatLeafTests::isPolarOfEdge(const FloatBody& body, std::uint32_t edge, const Edge& e,
                                   const glm::vec3& d, float slack) const noexcept {
  for (const std::uint32_t corner : body.tree.edges()[edge].opposite) {
    const glm::vec3 w = body.positions[corner] - e.start;
    const glm::vec3 inward = w - glm::dot(w, e.along) * e.along;
    const float along = glm::dot(d, inward);
    if (along > 0.0F && along > slack * glm::length(inward) + pointRounding_) return false;
  }
  return true;
}

bool FloatLeafTests::accept(const Side& frame, const glm::vec3& p, const glm::vec3& q,
                            const glm::vec3& direction, float distance, Minimum& out) const noexcept {
  out = Minimum{};
  const bool isSceneFrame = &frame == &scene_;
  out.least = out.lmd.distance = static_cast<double>(distance);
  out.lmd.scenePoint = glm::dvec3(isSceneFrame ? p : sceneFromPart_.point(q));
  out.lmd.partPoint = glm::dvec3(isSceneFrame ? q : sceneFromPart_.point(p));
  out.lmd.direction = glm::dvec3(isSceneFrame ? direction : sceneFromPart_.vector(-direction));
  return true;
}

bool FloatLeafTests::vertexFace(const Side& v, std::uint32_t vertex, const Side& f, std::uint32_t face,
                                Minimum& out) const noexcept {
  const Triangle& t = f.body.tree.faces()[face].corners;
  const std::vector<glm::vec3>& x = f.body.positions;
  const glm::vec3 q = v.otherFromThis.point(vertexOf(v.body, vertex));
  const glm::vec3 n = faceNormal(x[t[0]], x[t[1]], x[t[2]]);
  const float distance = glm::dot(n, q - x[t[0]]);
  if (!(distance > 0.0F) || distance > cutoff_) return false;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec3 &a = x[t[k]], &b = x[t[(k + 1) % 3]];
    const glm::vec3 inward = glm::cross(n, b - a);
    if (glm::dot(inward, q - a) < -lengthSlack(distance) * glm::length(inward)) return false;
  }
  if (!isPolarOfVertex(v.body, vertex, v.thisFromOther.vector(-n), kAngularTolerance)) return false;
  return accept(f, q - distance * n, q, n, distance, out);
}

bool FloatLeafTests::vertexEdge(const Side& v, std::uint32_t vertex, const Side& e, std::uint32_t edge,
                                Minimum& out) const noexcept {
  const Edge line = edgeOf(e.body, edge);
  const glm::vec3 q = v.otherFromThis.point(vertexOf(v.body, vertex));
  const float s = glm::dot(q - line.start, line.along);
  const glm::vec3 d = q - line.start - s * line.along;
  const float distance = glm::length(d);
  if (!(distance > 0.0F) || distance > cutoff_) return false;
  if (s < -lengthSlack(distance) || s > line.length + lengthSlack(distance)) return false;
  const glm::vec3 direction = d / distance;
  if (!isPolarOfEdge(e.body, edge, line, direction, angularSlack(distance))) return false;
  if (!isPolarOfVertex(v.body, vertex, v.thisFromOther.vector(-direction), angularSlack(distance)))
    return false;
  return accept(e, q - d, q, direction, distance, out);
}

bool FloatLeafTests::vertexVertex(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept {
  const glm::vec3& p = vertexOf(scene_.body, a);
  const glm::vec3 q = sceneFromPart_.point(vertexOf(part_.body, b));
  const float distance = glm::distance(p, q);
  if (!(distance > 0.0F) || distance > cutoff_) return false;
  const glm::vec3 direction = (q - p) / distance;
  if (!isPolarOfVertex(scene_.body, a, direction, angularSlack(distance))) return false;
  if (!isPolarOfVertex(part_.body, b, partFromScene_.vector(-direction), angularSlack(distance)))
    return false;
  return accept(scene_, p, q, direction, distance, out);
}

bool FloatLeafTests::edgeEdge(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept {
  const Edge ea = edgeOf(scene_.body, a), partEdge = edgeOf(part_.body, b);
  const Edge eb{sceneFromPart_.point(partEdge.start), sceneFromPart_.vector(partEdge.along), partEdge.length};
  const glm::vec3 across = glm::cross(ea.along, eb.along);
  const float sine = glm::length(across);
  if (sine <= kFlatTolerance) return parallelEdges(a, b, ea, eb, out);
  const glm::vec3 w = eb.start - ea.start;
  glm::vec3 direction = across / sine;
  float distance = glm::dot(w, direction);
  if (distance < 0.0F) {
    direction = -direction;
    distance = -distance;
  }
  if (!(distance > 0.0F) || distance > cutoff_) return false;
  const float slack = lengthSlack(distance);
  const float s = glm::dot(glm::cross(w, eb.along), across) / (sine * sine);
  const float t = glm::dot(glm::cross(w, ea.along), across) / (sine * sine);
  if (s < -slack || s > ea.length + slack || t < -slack || t > eb.length + slack) return false;
  if (!isPolarOfEdge(scene_.body, a, ea, direction, kAngularTolerance)) return false;
  if (!isPolarOfEdge(part_.body, b, partEdge, partFromScene_.vector(-direction), kAngularTolerance))
    return false;
  const glm::vec3 p = ea.start + s * ea.along;
  return accept(scene_, p, p + distance * direction, direction, distance, out);
}

bool FloatLeafTests::parallelEdges(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& eb,
                                   Minimum& out) const noexcept {
  const float s0 = glm::dot(eb.start - ea.start, ea.along),
              s1 = s0 + eb.length * glm::dot(eb.along, ea.along);
  const float from = std::max(0.0F, std::min(s0, s1)), to = std::min(ea.length, std::max(s0, s1));
  if (!(to - from > lengthTolerance_)) return false;
  const glm::vec3 p = ea.start + 0.5F * (from + to) * ea.along;
  const glm::vec3 q = eb.start + glm::dot(p - eb.start, eb.along) * eb.along;
  const float distance = glm::distance(p, q);
  if (!(distance > 0.0F) || distance > cutoff_) return false;
  const glm::vec3 direction = (q - p) / distance;
  const Edge partEdge = edgeOf(part_.body, b);
  if (!isPolarOfEdge(scene_.body, a, ea, direction, angularSlack(distance))) return false;
  if (!isPolarOfEdge(part_.body, b, partEdge, partFromScene_.vector(-direction), angularSlack(distance)))
    return false;
  accept(scene_, p, q, direction, distance, out);
  setSegment(glm::dvec3(ea.start + from * ea.along), glm::dvec3(ea.start + to * ea.along), out);
  return true;
}

bool FloatLeafTests::edgeFace(const Side& e, std::uint32_t edge, const Side& f, std::uint32_t face,
                              Minimum& out) const noexcept {
  const Triangle& t = f.body.tree.faces()[face].corners;
  const std::vector<glm::vec3>& x = f.body.positions;
  const glm::vec3 n = faceNormal(x[t[0]], x[t[1]], x[t[2]]);
  const Edge local = edgeOf(e.body, edge);
  const glm::vec3 along = e.otherFromThis.vector(local.along);
  if (std::abs(glm::dot(along, n)) > kFlatTolerance) return false;
  const glm::vec3 start = e.otherFromThis.point(local.start);
  const float distance = glm::dot(n, start + 0.5F * local.length * along - x[t[0]]);
  if (!(distance > 0.0F) || distance > cutoff_) return false;
  double from = 0.0, to = static_cast<double>(local.length);
  const std::array<glm::dvec3, 3> corners{x[t[0]], x[t[1]], x[t[2]]};
  if (!clipLine(corners, glm::dvec3(n), glm::dvec3(start), glm::dvec3(along),
                static_cast<double>(lengthSlack(distance)), from, to) ||
      !(to - from > static_cast<double>(lengthTolerance_))) {
    return false;
  }
  if (!isPolarOfEdge(e.body, edge, local, e.thisFromOther.vector(-n), kAngularTolerance)) return false;
  const auto first = start + static_cast<float>(from) * along, last = start + static_cast<float>(to) * along;
  const glm::vec3 q = 0.5F * (first + last);
  accept(f, q - distance * n, q, n, distance, out);
  const bool isSceneFrame = &f == &scene_;
  const auto onScene = [&](const glm::vec3& p) {
    return glm::dvec3(isSceneFrame ? p - distance * n : sceneFromPart_.point(p));
  };
  setSegment(onScene(first), onScene(last), out);
  return true;
}

bool FloatLeafTests::faceFace(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept {
  const Triangle &ta = scene_.body.tree.faces()[a].corners, &tb = part_.body.tree.faces()[b].corners;
  const std::vector<glm::vec3>&xa = scene_.body.positions, &xb = part_.body.positions;
  const glm::vec3 n = faceNormal(xa[ta[0]], xa[ta[1]], xa[ta[2]]);
  const glm::vec3 m = sceneFromPart_.vector(faceNormal(xb[tb[0]], xb[tb[1]], xb[tb[2]]));
  if (glm::dot(n, m) > 0.0F || glm::length(glm::cross(n, m)) > kFlatTolerance) return false;
  const float first = glm::dot(n, sceneFromPart_.point(xb[tb[0]]) - xa[ta[0]]);
  const float spread = kFlatTolerance * part_.body.size;
  if (first < -spread || first > cutoff_ + spread) return false;
  const std::array<glm::dvec3, 3> corners{xa[ta[0]], xa[ta[1]], xa[ta[2]]};
  ConvexPolygon overlap;
  overlap.count = 3;
  for (std::size_t k = 0; k < 3; ++k)
    overlap.corners[k] = glm::dvec3(sceneFromPart_.point(xb[tb[k]]));
  const glm::dvec3 normal(n);
  clipPolygon(corners, normal, overlap);
  glm::dvec3 centroid;
  const double area = polygonArea(overlap, normal, centroid);
  if (!(area > static_cast<double>(lengthTolerance_ * lengthTolerance_))) return false;
  const double distance = glm::dot(normal, centroid - corners[0]);
  if (!(distance > 0.0) || distance > static_cast<double>(cutoff_)) return false;
  accept(scene_, glm::vec3(centroid - distance * normal), glm::vec3(centroid), n,
         static_cast<float>(distance), out);
  out.dimension = 2;
  out.weight = area;
  out.cornerCount = static_cast<std::uint8_t>(overlap.count);
  for (std::size_t k = 0; k < overlap.count; ++k) {
    out.corners[k] = overlap.corners[k] - glm::dot(normal, overlap.corners[k] - corners[0]) * normal;
    out.radius = std::max(out.radius, glm::distance(out.corners[k], out.lmd.scenePoint));
  }
  return true;
}

void FloatLeafTests::setSegment(const glm::dvec3& from, const glm::dvec3& to, Minimum& out) noexcept {
  out.dimension = 1;
  out.weight = glm::distance(from, to);
  out.cornerCount = 2;
  out.corners[0] = from;
  out.corners[1] = to;
  out.radius = 0.5 * out.weight;
}

}  // namespace nearfit::bench
