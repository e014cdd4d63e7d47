#include "core/proximity/query/leaf_tests.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"
#include "core/proximity/query/polygon_clip.h"
#include "core/proximity/query/relaxed_conditions.h"

namespace nearfit {
namespace {

/// Outward unit normal of a face with non-zero area.
glm::dvec3 faceNormal(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept {
  return glm::normalize(glm::cross(b - a, c - a));
}

/// Height of a triangle over its longest side [m].
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
      margins_(scene, part, sceneFromPart),
      cutoff_(cutoff),
      relaxation_(relaxation),
      mostDistance_(cutoff + kDistanceTolerance * (scene.size() + part.size())),
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
  if (tree.rule() == AcceptanceRule::NormalSpan) [[unlikely]]
    return isInSpanOfVertex(tree, vertex, d, slack);
  const NormalConeTree::VertexLeaf& leaf = tree.vertices()[vertex];
  const glm::dvec3& v = tree.positions()[leaf.vertex];
  bool isInside = true;
  for (const std::uint32_t n : tree.neighbours(leaf)) {
    const glm::dvec3 e = tree.positions()[n] - v;
    const double along = glm::dot(d, e);
    if (!(along > 0.0)) continue;
    if (along > slack * glm::length(e) + pointRounding_) return false;
    isInside = false;
  }
  return isInside || !(relaxation_ > 0.0) ||
         isNearPolarCone(v, tree.neighbours(leaf), tree.positions(), d, slack);
}

bool LeafTests::isInSpanOfVertex(const NormalConeTree& tree, std::uint32_t vertex, const glm::dvec3& d,
                                 double slack) const noexcept {
  const NormalConeTree::VertexLeaf& leaf = tree.vertices()[vertex];
  for (const glm::dvec3& wall : tree.walls(leaf)) {
    if (glm::dot(d, wall) < -slack) return false;
  }
  const glm::dvec3& v = tree.positions()[leaf.vertex];
  const auto leadsAway = [&](std::uint32_t corner) {
    const glm::dvec3 e = tree.positions()[corner] - v;
    return glm::dot(d, e) <= slack * glm::length(e) + pointRounding_;
  };
  const std::span<const std::uint32_t> corners = tree.neighbours(leaf);
  for (std::size_t i = 0; i + 1 < corners.size(); i += 2) {
    if (leadsAway(corners[i]) && leadsAway(corners[i + 1])) return true;
  }
  return false;
}

std::array<glm::dvec3, 2> LeafTests::inwardOf(const NormalConeTree& tree, std::uint32_t edge,
                                              const Edge& e) noexcept {
  std::array<glm::dvec3, 2> inward;
  for (std::size_t i = 0; i < inward.size(); ++i) {
    const glm::dvec3 w = tree.positions()[tree.edges()[edge].opposite[i]] - e.start;
    inward[i] = w - glm::dot(w, e.along) * e.along;
  }
  return inward;
}

bool LeafTests::isPolarOfEdge(const NormalConeTree& tree, std::uint32_t edge, const Edge& e,
                              const glm::dvec3& d, double slack) const noexcept {
  const std::array<glm::dvec3, 2> inward = inwardOf(tree, edge, e);
  bool isInside = true;
  for (const glm::dvec3& in : inward) {
    const double along = glm::dot(d, in);
    if (!(along > 0.0)) continue;
    if (along > slack * glm::length(in) + pointRounding_) return false;
    isInside = false;
  }
  return isInside || !(relaxation_ > 0.0) || isOnSideOfPolarArc(inward, d);
}

void LeafTests::accept(const Side& frame, const glm::dvec3& p, const glm::dvec3& q,
                       const glm::dvec3& direction, double distance, Minimum& out) const noexcept {
  out.dimension = 0;
  out.cornerCount = 0;
  out.weight = 0.0;
  out.isOverlapping = false;
  out.least = distance;
  out.lmd.extent = {};
  out.lmd.isMarginal = false;
  out.lmd.distance = distance;
  const bool isSceneFrame = &frame == &scene_;
  // p lies on the body whose frame this is.
  out.lmd.scenePoint = isSceneFrame ? p : sceneFromPart_.applyToPoint(q);
  out.lmd.partPoint = isSceneFrame ? q : sceneFromPart_.applyToPoint(p);
  out.lmd.direction = isSceneFrame ? direction : sceneFromPart_.applyToVector(-direction);
}

bool LeafTests::vertexFace(const Side& v, std::uint32_t vertex, const Side& f, std::uint32_t face,
                           Minimum& out) const noexcept {
  const Triangle& t = f.tree.faces()[face].corners;
  const auto x = f.tree.positions();
  const glm::dvec3 q = v.otherFromThis.applyToPoint(v.tree.positions()[v.tree.vertices()[vertex].vertex]);
  const glm::dvec3 n = faceNormal(x[t[0]], x[t[1]], x[t[2]]);
  const double distance = glm::dot(n, q - x[t[0]]);
  if (!(distance > 0.0) || distance > mostDistance_) return false;
  // A thin face's normal has an error of one rounding over its height.
  const double height = leastHeight(x[t[0]], x[t[1]], x[t[2]]), tilt = pointRounding_ / height;
  const double slack = lengthSlack(distance) + tilt * distance;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &a = x[t[k]], &b = x[t[(k + 1) % 3]];
    const glm::dvec3 inward = glm::cross(n, b - a);
    if (glm::dot(inward, q - a) < -slack * glm::length(inward)) return false;
  }
  if (relaxation_ > 0.0 && !isNearTriangle({x[t[0]], x[t[1]], x[t[2]]}, n, q, slack)) return false;
  if (!vertexOver(v, vertex, f, {q, n, distance, tilt}, out)) return false;
  const double points = 2.0 * margins_.pointError(), turn = LeafMargins::angularErrorOfFace(f.tree, height);
  const auto error = [&] { return points + turn * glm::distance(q, x[t[0]]); };
  const auto isClear = [&] {
    return LeafMargins::isClearInFace({x[t[0]], x[t[1]], x[t[2]]}, n, q, points + turn * distance) &&
           LeafMargins::isClearOfVertex(v.tree, vertex, v.thisFromOther.applyToVector(-n), turn);
  };
  return settle(error, isClear, out);
}

bool LeafTests::vertexOver(const Side& v, std::uint32_t vertex, const Side& f, const OverFace& over,
                           Minimum& out) const noexcept {
  const glm::dvec3 down = v.thisFromOther.applyToVector(-over.normal);
  if (!isPolarOfVertex(v.tree, vertex, down, angularSlackBase_ + over.tilt)) return false;
  accept(f, over.vertex - over.distance * over.normal, over.vertex, over.normal, over.distance, out);
  return true;
}

bool LeafTests::testOverFace(std::uint32_t sceneLeaf, std::uint32_t partLeaf, const OverFace& over,
                             Minimum& out) const noexcept {
  const bool isSceneFace = NormalConeTree::leafKind(sceneLeaf) == FeatureKind::Face;
  const std::uint32_t vertex = NormalConeTree::leafIndex(isSceneFace ? partLeaf : sceneLeaf);
  return isSceneFace ? vertexOver(part_, vertex, scene_, over, out)
                     : vertexOver(scene_, vertex, part_, over, out);
}

bool LeafTests::vertexEdge(const Side& v, std::uint32_t vertex, const Side& e, std::uint32_t edge,
                           Minimum& out) const noexcept {
  const Edge line = edgeOf(e.tree, edge);
  const glm::dvec3 q = v.otherFromThis.applyToPoint(v.tree.positions()[v.tree.vertices()[vertex].vertex]);
  const glm::dvec3 w = q - line.start;
  const double s = glm::dot(w, line.along);
  const glm::dvec3 d = w - s * line.along;
  const double distance = glm::length(d);
  if (!(distance > 0.0) || distance > mostDistance_) return false;
  const double slack = lengthSlack(distance);
  if (s < -slack || s > line.length + slack) return false;
  const glm::dvec3 direction = d / distance;
  if (!isPolarOfEdge(e.tree, edge, line, direction, angularSlack(distance))) return false;
  const glm::dvec3 back = v.thisFromOther.applyToVector(-direction);
  if (!isPolarOfVertex(v.tree, vertex, back, directionRounding(distance))) return false;
  accept(e, q - d, q, direction, distance, out);
  const auto error = [this] { return 2.0 * margins_.pointError(); };
  const auto isClear = [&] {
    const double place = error() + LeafMargins::angularErrorOfEdge(e.tree, line.length) * distance;
    const double turn = margins_.angularErrorOfPoints(distance);
    return LeafMargins::isClearAlong(s, line.length, place) &&
           isClearOfEdge(e, edge, line, direction, turn) &&
           LeafMargins::isClearOfVertex(v.tree, vertex, back, turn);
  };
  return settle(error, isClear, out);
}

bool LeafTests::vertexVertex(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept {
  const glm::dvec3& p = scene_.tree.positions()[scene_.tree.vertices()[a].vertex];
  const glm::dvec3 q = sceneFromPart_.applyToPoint(part_.tree.positions()[part_.tree.vertices()[b].vertex]);
  const double distance = glm::distance(p, q);
  if (!(distance > 0.0) || distance > mostDistance_) return false;
  const glm::dvec3 direction = (q - p) / distance;
  const double angular = directionRounding(distance);
  if (!isPolarOfVertex(scene_.tree, a, direction, angular)) return false;
  const glm::dvec3 back = partFromScene_.applyToVector(-direction);
  if (!isPolarOfVertex(part_.tree, b, back, angular)) return false;
  accept(scene_, p, q, direction, distance, out);
  const auto isClear = [&] {
    const double turn = margins_.angularErrorOfPoints(distance);
    return LeafMargins::isClearOfVertex(scene_.tree, a, direction, turn) &&
           LeafMargins::isClearOfVertex(part_.tree, b, back, turn);
  };
  return settle([this] { return 2.0 * margins_.pointError(); }, isClear, out);
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
  // A cheap test before costly ones: the height of the edge's lower end.
  if (startHeight + std::min(0.0, local.length * rise) > mostDistance_) return false;
  double from = 0.0, to = local.length;
  if (!clipLine(corners, n, start, along, lengthSlack(std::abs(startHeight)), from, to) ||
      !(to - from > lengthTolerance_)) {
    return false;
  }
  const double distance = startHeight + 0.5 * (from + to) * rise;
  const double least = startHeight + std::min(from * rise, to * rise);
  if (!(distance > 0.0) || least > mostDistance_) return false;
  const glm::dvec3 down = e.thisFromOther.applyToVector(-n);
  if (!isPolarOfEdge(e.tree, edge, local, down, angularSlackBase_)) return false;
  const glm::dvec3 q = start + 0.5 * (from + to) * along;
  accept(f, q - distance * n, q, n, distance, out);
  const glm::dvec3 first = start + from * along, last = start + to * along;
  if (&f == &scene_) {
    setSegment(first - (startHeight + from * rise) * n, last - (startHeight + to * rise) * n, out);
  } else {
    setSegment(sceneFromPart_.applyToPoint(first), sceneFromPart_.applyToPoint(last), out);
  }
  out.least = least;
  const double points = 2.0 * margins_.pointError();
  const double turn =
      LeafMargins::angularErrorOfFace(f.tree, leastHeight(corners[0], corners[1], corners[2]));
  const auto error = [&] { return points + turn * glm::distance(q, corners[0]); };
  const auto isClear = [&] {
    return LeafMargins::isClearInFace(corners, n, q, points + turn * distance) &&
           isClearOfEdge(e, edge, local, down, turn);
  };
  return settle(error, isClear, out);
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
  const double points = 2.0 * margins_.pointError();
  const double turn = LeafMargins::angularErrorOfFace(scene_.tree, leastHeight(pa[0], pa[1], pa[2]));
  const auto error = [&] { return points + turn * glm::distance(centroid, pa[0]); };
  // In exact arithmetic, an overlap no wider than rounding may not exist.
  const auto isClear = [&] { return area > 2.0 * out.radius * (points + turn * distance); };
  return settle(error, isClear, out);
}

}  // namespace nearfit
