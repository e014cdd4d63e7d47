#include "core/proximity/leaf_tests.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"
#include "core/proximity/polygon_clip.h"

namespace nearfit {
namespace {

/// Outward unit normal of a face that has an area.
glm::dvec3 faceNormal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept {
  return glm::normalize(glm::cross(b - a, c - a));
}

/// Height of a triangle over its longest side.
double leastHeight(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept {
  const glm::dvec3 u = b - a, v = c - b, w = a - c;
  const double longest = std::max({glm::dot(u, u), glm::dot(v, v), glm::dot(w, w)});
  return glm::length(glm::cross(u, w)) / std::sqrt(longest);
}

}  // namespace

LeafTests::LeafTests(const NormalConeTree& scene, const NormalConeTree& part,
                     const RigidTransform& sceneFromPart, double cutoff, double relaxation) noexcept
    : sceneFromPart_(sceneFromPart),
      partFromScene_(sceneFromPart.inverse()),
      scene_{scene, partFromScene_, sceneFromPart_},
      part_{part, sceneFromPart_, partFromScene_},
      cutoff_(cutoff),
      relaxation_(relaxation),
      lengthTolerance_(kLengthTolerance * (scene.size() + part.size())),
      angularSlackBase_(kAngularTolerance + relaxation),
      pointRounding_(kPointRounding * (scene.size() + part.size() + glm::length(sceneFromPart.translation))) {
}

bool LeafTests::test(std::uint32_t sceneLeaf, std::uint32_t partLeaf, Minimum& out) const noexcept {
  using enum FeatureKind;
  const FeatureKind a = NormalConeTree::leafKind(sceneLeaf), b = NormalConeTree::leafKind(partLeaf);
  const std::uint32_t i = NormalConeTree::leafIndex(sceneLeaf), j = NormalConeTree::leafIndex(partLeaf);
  out.dimension = 0;
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
  const auto meshIndex = [](const NormalConeTree& tree, FeatureKind kind, std::uint32_t index) {
    return kind == Vertex ? tree.vertices()[index].vertex
           : kind == Edge ? tree.edges()[index].edge
                          : tree.faces()[index].face;
  };
  out.lmd.sceneFeature = a;
  out.lmd.partFeature = b;
  out.lmd.sceneIndex = meshIndex(scene_.tree, a, i);
  out.lmd.partIndex = meshIndex(part_.tree, b, j);
  out.lmd.isRegion = out.dimension > 0;
  return true;
}

LeafTests::Edge LeafTests::edgeOf(const NormalConeTree& tree, std::uint32_t edge) noexcept {
  const NormalConeTree::EdgeLeaf& leaf = tree.edges()[edge];
  const glm::dvec3 &a = tree.positions()[leaf.v0], &b = tree.positions()[leaf.v1];
  const double length = glm::distance(a, b);
  return {a, (b - a) / length, length};
}

bool LeafTests::isPolarOfVertex(const NormalConeTree& tree, std::uint32_t vertex, const glm::dvec3& d,
                                double slack) const noexcept {
  const NormalConeTree::VertexLeaf& leaf = tree.vertices()[vertex];
  const glm::dvec3& v = tree.positions()[leaf.vertex];
  for (const std::uint32_t n : tree.neighbours(leaf)) {
    const glm::dvec3 e = tree.positions()[n] - v;
    const double along = glm::dot(d, e);
    if (along > 0.0 && along > slack * glm::length(e) + pointRounding_) return false;
  }
  return true;
}

bool LeafTests::isPolarOfEdge(const NormalConeTree& tree, std::uint32_t edge, const Edge& e,
                              const glm::dvec3& d, double slack) const noexcept {
  for (const std::uint32_t corner : tree.edges()[edge].opposite) {
    const glm::dvec3 w = tree.positions()[corner] - e.start;
    const glm::dvec3 inward = w - glm::dot(w, e.along) * e.along;
    const double along = glm::dot(d, inward);
    if (along > 0.0 && along > slack * glm::length(inward) + pointRounding_) return false;
  }
  return true;
}

bool LeafTests::accept(const Side& frame, const glm::dvec3& p, const glm::dvec3& q,
                       const glm::dvec3& direction, double distance, Minimum& out) const noexcept {
  out.dimension = 0;
  out.cornerCount = 0;
  out.weight = 0.0;
  out.isOverlapping = false;
  out.least = distance;
  out.lmd.extent = {};
  out.lmd.distance = distance;
  const bool isSceneFrame = &frame == &scene_;
  // p belongs to the body in whose frame we are.
  out.lmd.scenePoint = isSceneFrame ? p : sceneFromPart_.applyToPoint(q);
  out.lmd.partPoint = isSceneFrame ? q : sceneFromPart_.applyToPoint(p);
  out.lmd.direction = isSceneFrame ? direction : sceneFromPart_.applyToVector(-direction);
  return true;
}

bool LeafTests::vertexFace(const Side& v, std::uint32_t vertex, const Side& f, std::uint32_t face,
                           Minimum& out) const noexcept {
  const Triangle& t = f.tree.faces()[face].corners;
  const auto x = f.tree.positions();
  const glm::dvec3 q = v.otherFromThis.applyToPoint(v.tree.positions()[v.tree.vertices()[vertex].vertex]);
  const glm::dvec3 n = faceNormal(x[t[0]], x[t[1]], x[t[2]]);
  const double distance = glm::dot(n, q - x[t[0]]);
  if (!(distance > 0.0) || distance > cutoff_) return false;
  // The normal of a thin face is known to a rounding over its height.
  const double tilt = pointRounding_ / leastHeight(x[t[0]], x[t[1]], x[t[2]]);
  const double slack = lengthSlack(distance) + tilt * distance;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &a = x[t[k]], &b = x[t[(k + 1) % 3]];
    const glm::dvec3 inward = glm::cross(n, b - a);
    if (glm::dot(inward, q - a) < -slack * glm::length(inward)) return false;
  }
  if (!isPolarOfVertex(v.tree, vertex, v.thisFromOther.applyToVector(-n), angularSlackBase_ + tilt))
    return false;
  return accept(f, q - distance * n, q, n, distance, out);
}

bool LeafTests::vertexEdge(const Side& v, std::uint32_t vertex, const Side& e, std::uint32_t edge,
                           Minimum& out) const noexcept {
  const Edge line = edgeOf(e.tree, edge);
  const glm::dvec3 q = v.otherFromThis.applyToPoint(v.tree.positions()[v.tree.vertices()[vertex].vertex]);
  const glm::dvec3 w = q - line.start;
  const double s = glm::dot(w, line.along);
  const glm::dvec3 d = w - s * line.along;
  const double distance = glm::length(d);
  if (!(distance > 0.0) || distance > cutoff_) return false;
  const double slack = lengthSlack(distance);
  if (s < -slack || s > line.length + slack) return false;
  const glm::dvec3 direction = d / distance;
  if (!isPolarOfEdge(e.tree, edge, line, direction, angularSlack(distance))) return false;
  if (!isPolarOfVertex(v.tree, vertex, v.thisFromOther.applyToVector(-direction),
                       directionRounding(distance))) {
    return false;
  }
  return accept(e, q - d, q, direction, distance, out);
}

bool LeafTests::vertexVertex(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept {
  const glm::dvec3& p = scene_.tree.positions()[scene_.tree.vertices()[a].vertex];
  const glm::dvec3 q = sceneFromPart_.applyToPoint(part_.tree.positions()[part_.tree.vertices()[b].vertex]);
  const double distance = glm::distance(p, q);
  if (!(distance > 0.0) || distance > cutoff_) return false;
  const glm::dvec3 direction = (q - p) / distance;
  const double angular = directionRounding(distance);
  if (!isPolarOfVertex(scene_.tree, a, direction, angular)) return false;
  if (!isPolarOfVertex(part_.tree, b, partFromScene_.applyToVector(-direction), angular)) return false;
  return accept(scene_, p, q, direction, distance, out);
}

bool LeafTests::edgeFace(const Side& e, std::uint32_t edge, const Side& f, std::uint32_t face,
                         Minimum& out) const noexcept {
  const Triangle& t = f.tree.faces()[face].corners;
  const auto x = f.tree.positions();
  const std::array<glm::dvec3, 3> corners{x[t[0]], x[t[1]], x[t[2]]};
  const glm::dvec3 n = faceNormal(corners[0], corners[1], corners[2]);
  const Edge local = edgeOf(e.tree, edge);
  const glm::dvec3 along = e.otherFromThis.applyToVector(local.along);
  const double rise = glm::dot(along, n);
  if (std::abs(rise) > kFlatTolerance) return false;
  const glm::dvec3 start = e.otherFromThis.applyToPoint(local.start);
  const double startHeight = glm::dot(n, start - corners[0]);
  // Before anything that costs: how high the edge's lower end is.
  if (startHeight + std::min(0.0, local.length * rise) > cutoff_) return false;
  double from = 0.0, to = local.length;
  if (!clipLine(corners, n, start, along, lengthSlack(std::abs(startHeight)), from, to) ||
      !(to - from > lengthTolerance_)) {
    return false;
  }
  const double distance = startHeight + 0.5 * (from + to) * rise;
  const double least = startHeight + std::min(from * rise, to * rise);
  if (!(distance > 0.0) || least > cutoff_) return false;
  if (!isPolarOfEdge(e.tree, edge, local, e.thisFromOther.applyToVector(-n), angularSlackBase_)) return false;
  const glm::dvec3 q = start + 0.5 * (from + to) * along;
  accept(f, q - distance * n, q, n, distance, out);
  const glm::dvec3 first = start + from * along, last = start + to * along;
  if (&f == &scene_) {
    setSegment(first - (startHeight + from * rise) * n, last - (startHeight + to * rise) * n, out);
  } else {
    setSegment(sceneFromPart_.applyToPoint(first), sceneFromPart_.applyToPoint(last), out);
  }
  out.least = least;
  return true;
}

bool LeafTests::faceFace(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept {
  const Triangle &ta = scene_.tree.faces()[a].corners, &tb = part_.tree.faces()[b].corners;
  const auto xa = scene_.tree.positions(), xb = part_.tree.positions();
  const std::array<glm::dvec3, 3> pa{xa[ta[0]], xa[ta[1]], xa[ta[2]]};
  const glm::dvec3 n = faceNormal(pa[0], pa[1], pa[2]);
  const glm::dvec3 nb = sceneFromPart_.applyToVector(faceNormal(xb[tb[0]], xb[tb[1]], xb[tb[2]]));
  if (glm::dot(n, nb) >= 0.0 || glm::length(n + nb) > kFlatTolerance) return false;
  ConvexPolygon overlap;
  overlap.count = 3;
  for (std::size_t k = 0; k < 3; ++k)
    overlap.corners[k] = sceneFromPart_.applyToPoint(xb[tb[k]]);
  const auto height = [&](const glm::dvec3& p) { return glm::dot(n, p - pa[0]); };
  const double first = height(overlap.corners[0]);
  const double spread = kFlatTolerance * part_.tree.size();
  if (first < -spread || first > cutoff_ + spread) return false;
  clipPolygon(pa, n, overlap);
  glm::dvec3 centroid;
  const double area = polygonArea(overlap, n, centroid);
  if (!(area > lengthTolerance_ * lengthTolerance_)) return false;
  const double distance = height(centroid);
  if (!(distance > 0.0) || distance > cutoff_ + spread) return false;
  accept(scene_, centroid - distance * n, centroid, n, distance, out);
  out.dimension = 2;
  out.weight = area;
  out.cornerCount = static_cast<std::uint8_t>(overlap.count);
  out.radius = 0.0;
  for (std::size_t k = 0; k < overlap.count; ++k) {
    const double above = height(overlap.corners[k]);
    out.least = std::min(out.least, above);
    out.corners[k] = overlap.corners[k] - above * n;
    out.radius = std::max(out.radius, glm::distance(out.corners[k], out.lmd.scenePoint));
  }
  return out.least <= cutoff_;
}

}  // namespace nearfit
