#include "tests/bench/paper_hierarchy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace nearfit::bench {
namespace {

/// Added to lengths that prune, over their rounding [of the lengths in play].
constexpr double kPruningPad = 1e-9;
/// Taken off cosines that prune: no direction is lost that kSpanTolerance takes in.
constexpr double kCosinePad = 2.0 * kSpanTolerance;
/// Normals closer than this are one [length of their difference].
constexpr double kSameNormal = 1e-9;

/// Cosine and sine of an angle from 0 to pi.
struct Angle {
  double cosine, sine;
};

/// True if an angle of that cosine is surely larger than a + b.
bool isBeyond(double cosine, const Angle& a, const Angle& b) noexcept {
  // Together at least half a turn: nothing is.
  if (a.cosine + b.cosine <= 0.0) return false;
  return cosine < a.cosine * b.cosine - a.sine * b.sine - kCosinePad;
}

Angle halfAngleOf(const PaperHierarchy::Node& node) noexcept {
  return {node.cosHalf, node.sinHalf};
}

/// True if a unit direction lies in a leaf's cone, to within kSpanTolerance.
bool isInCone(const glm::dvec3& direction, const PaperHierarchy::Node& leaf) noexcept {
  const double angle = std::acos(std::clamp(glm::dot(direction, leaf.axis), -1.0, 1.0));
  return angle <= std::atan2(leaf.sinHalf, leaf.cosHalf) + kSpanTolerance;
}

glm::dvec3 unitOrZero(const glm::dvec3& v) noexcept {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : glm::dvec3(0.0);
}

/// Eigenvectors of a symmetric matrix as columns, that of the largest value first: Jacobi's rotations.
glm::dmat3 axesOf(glm::dmat3 m) noexcept {
  constexpr int kSweeps = 32;
  glm::dmat3 v(1.0);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const auto& [p, q] : {std::pair{0, 1}, std::pair{0, 2}, std::pair{1, 2}}) {
      if (m[p][q] == 0.0) continue;
      const double theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
      const double t = (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
      const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
      glm::dmat3 rotation(1.0);
      rotation[p][p] = rotation[q][q] = c;
      rotation[q][p] = s;
      rotation[p][q] = -s;
      m = glm::transpose(rotation) * m * rotation;
      v = v * rotation;
    }
  }
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return m[a][a] > m[b][b]; });
  return {v[order[0]], v[order[1]], v[order[2]]};
}

/// Nearest points of two segments (Ericson, Real-Time Collision Detection, 5.1.9). Places: 0, 1 for an end, 2
/// between.
struct SegmentsNear {
  glm::dvec3 p, q;
  int placeOnP, placeOnQ;
};

int placeOf(double s) noexcept {
  return s <= 0.0 ? 0 : (s >= 1.0 ? 1 : 2);
}

SegmentsNear nearestOfSegments(const glm::dvec3& p0, const glm::dvec3& p1, const glm::dvec3& q0,
                               const glm::dvec3& q1) noexcept {
  const glm::dvec3 u = p1 - p0, v = q1 - q0, w = p0 - q0;
  const double a = glm::dot(u, u), e = glm::dot(v, v), b = glm::dot(u, v), c = glm::dot(u, w),
               f = glm::dot(v, w);
  const double denominator = a * e - b * b;
  double s = denominator > 0.0 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0.0) {
    t = 0.0;
    s = std::clamp(-c / a, 0.0, 1.0);
  } else if (t > 1.0) {
    t = 1.0;
    s = std::clamp((b - c) / a, 0.0, 1.0);
  }
  return {p0 + s * u, q0 + t * v, placeOf(s), placeOf(t)};
}

/// Nearest point of a triangle to a point (Ericson, 5.1.5), with its place as in TrianglesNear.
std::pair<glm::dvec3, std::uint8_t> nearestOnTriangle(const glm::dvec3& p,
                                                      const glm::dvec3 (&t)[3]) noexcept {
  const glm::dvec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return {t[0], 0};
  const glm::dvec3 bp = p - t[1];
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return {t[1], 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {t[0] + d1 / (d1 - d3) * ab, 3};
  const glm::dvec3 cp = p - t[2];
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return {t[2], 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {t[0] + d2 / (d2 - d6) * ac, 5};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0)
    return {t[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t[2] - t[1]), 4};
  const double sum = va + vb + vc;
  return {t[0] + vb / sum * ab + vc / sum * ac, 6};
}

/// True if an edge of one triangle passes through the inside of the other.
bool isPierced(const glm::dvec3 (&face)[3], const glm::dvec3 (&edges)[3]) noexcept {
  const glm::dvec3 n = glm::cross(face[1] - face[0], face[2] - face[0]);
  const std::array<double, 3> side{glm::dot(n, edges[0] - face[0]), glm::dot(n, edges[1] - face[0]),
                                   glm::dot(n, edges[2] - face[0])};
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if (side[k] * side[next] > 0.0 || side[k] == side[next]) continue;
    const glm::dvec3 x = edges[k] + side[k] / (side[k] - side[next]) * (edges[next] - edges[k]);
    bool isInside = true;
    for (int i = 0; i < 3; ++i)
      isInside = isInside && glm::dot(glm::cross(face[(i + 1) % 3] - face[i], x - face[i]), n) >= 0.0;
    if (isInside) return true;
  }
  return false;
}

/// True if one triangle's plane, or one square to it along a side, is surely farther than the cutoff from all of the
/// other triangle: much quicker than their distance.
bool isApart(const glm::dvec3 (&face)[3], const glm::dvec3 (&other)[3], double cutoff) noexcept {
  const glm::dvec3 normal = glm::cross(face[1] - face[0], face[2] - face[0]);
  const auto isBeyondPlane = [&](const glm::dvec3& n, const glm::dvec3& origin, bool bothSides) {
    const double x = glm::dot(n, other[0] - origin), y = glm::dot(n, other[1] - origin),
                 z = glm::dot(n, other[2] - origin);
    const double reach = cutoff * (1.0 + kPruningPad) * glm::length(n);
    return std::min({x, y, z}) > reach || (bothSides && std::max({x, y, z}) < -reach);
  };
  if (isBeyondPlane(normal, face[0], true)) return true;
  for (int k = 0; k < 3; ++k) {
    if (isBeyondPlane(glm::cross(face[(k + 1) % 3] - face[k], normal), face[k], false)) return true;
  }
  return false;
}

/// True if d lies on the arc between two unit normals, or at its ends.
bool isOnArc(const glm::dvec3& d, const glm::dvec3& a, const glm::dvec3& b) noexcept {
  const glm::dvec3 across = glm::cross(a, b);
  const double sine = glm::length(across);
  if (!(sine > kSameNormal)) return false;
  const glm::dvec3 n = across / sine;
  return std::abs(glm::dot(d, n)) <= kSpanTolerance && glm::dot(glm::cross(a, d), n) >= -kSpanTolerance &&
         glm::dot(glm::cross(d, b), n) >= -kSpanTolerance && glm::dot(d, a + b) > 0.0;
}

/// True if d lies in the cone of three unit normals that are not in a plane.
bool isInTrihedron(const glm::dvec3& d, const glm::dvec3& a, const glm::dvec3& b,
                   const glm::dvec3& c) noexcept {
  const double volume = glm::dot(a, glm::cross(b, c));
  if (!(std::abs(volume) > kSameNormal)) return false;
  const double sign = volume > 0.0 ? 1.0 : -1.0;
  for (const glm::dvec3& wall : {glm::cross(a, b), glm::cross(b, c), glm::cross(c, a)}) {
    if (sign * glm::dot(d, wall) < -kSpanTolerance * glm::length(wall)) return false;
  }
  return true;
}

std::vector<glm::dvec3> distinct(std::span<const glm::dvec3> normals) {
  std::vector<glm::dvec3> out;
  for (const glm::dvec3& n : normals) {
    if (n == glm::dvec3(0.0)) continue;
    const bool isThere = std::any_of(out.begin(), out.end(), [&](const glm::dvec3& other) {
      return glm::distance(n, other) <= kSameNormal;
    });
    if (!isThere) out.push_back(n);
  }
  return out;
}

}  // namespace

TrianglesNear nearestOf(const glm::dvec3 (&a)[3], const glm::dvec3 (&b)[3]) noexcept {
  TrianglesNear best{std::numeric_limits<double>::infinity(), {}, {}, 0, 0};
  const auto offer = [&best](const glm::dvec3& p, const glm::dvec3& q, int placeOnA, int placeOnB) {
    const glm::dvec3 between = q - p;
    const double squared = glm::dot(between, between);
    if (squared < best.distance)
      best = {squared, p, q, static_cast<std::uint8_t>(placeOnA), static_cast<std::uint8_t>(placeOnB)};
  };
  const auto placeOnEdge = [](int k, int place) { return place == 2 ? 3 + k : (k + place) % 3; };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const SegmentsNear near = nearestOfSegments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
      offer(near.p, near.q, placeOnEdge(i, near.placeOnP), placeOnEdge(j, near.placeOnQ));
    }
  }
  for (int k = 0; k < 3; ++k) {
    const auto [onB, placeOnB] = nearestOnTriangle(a[k], b);
    if (placeOnB == 6) offer(a[k], onB, k, placeOnB);
    const auto [onA, placeOnA] = nearestOnTriangle(b[k], a);
    if (placeOnA == 6) offer(onA, b[k], placeOnA, k);
  }
  best.distance = std::sqrt(best.distance);
  if (best.distance > 0.0 && (isPierced(a, b) || isPierced(b, a))) best.distance = 0.0;
  return best;
}

bool isInSpan(const glm::dvec3& direction, std::span<const glm::dvec3> normals) noexcept {
  // A convex cone is the union of the cones of one, two and three of its generators (Caratheodory).
  const std::vector<glm::dvec3> n = distinct(normals);
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (glm::distance(direction, n[i]) <= kSpanTolerance) return true;
    for (std::size_t j = i + 1; j < n.size(); ++j) {
      if (isOnArc(direction, n[i], n[j])) return true;
      for (std::size_t k = j + 1; k < n.size(); ++k) {
        if (isInTrihedron(direction, n[i], n[j], n[k])) return true;
      }
    }
  }
  return false;
}

/// Triangles in an order that splits rearrange, and their normals.
struct PaperHierarchy::Builder {
  std::vector<std::uint32_t> triangles;
  std::vector<glm::dvec3> centroids;
  std::vector<glm::dvec3> scratch{};
};

PaperHierarchy::PaperHierarchy(const TriangleMesh& mesh, PaperRule rule) : mesh_(mesh), rule_(rule) {
  const auto points = mesh.vertices();
  const auto triangles = mesh.triangles();
  if (triangles.empty()) return;
  vertexNormals_.assign(points.size(), glm::dvec3(0.0));
  firstFace_.assign(points.size() + 1, 0);
  Builder builder;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto& [i, j, k] = triangles[t];
    const glm::dvec3 normal = glm::cross(points[j] - points[i], points[k] - points[i]);
    faceNormals_.push_back(unitOrZero(normal));
    builder.triangles.push_back(t);
    builder.centroids.push_back((points[i] + points[j] + points[k]) / 3.0);
    for (const std::uint32_t corner : triangles[t]) {
      vertexNormals_[corner] += normal;  // Weighted by area.
      ++firstFace_[corner + 1];
    }
  }
  for (glm::dvec3& n : vertexNormals_)
    n = unitOrZero(n);
  for (std::size_t v = 0; v < points.size(); ++v)
    firstFace_[v + 1] += firstFace_[v];
  vertexFaces_.resize(firstFace_.back());
  std::vector<std::uint32_t> next(firstFace_.begin(), firstFace_.end() - 1);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t corner : triangles[t])
      vertexFaces_[next[corner]++] = t;
  }
  nodes_.reserve(2 * triangles.size());
  build(builder, 0, triangles.size());
  boxCentre_ = nodes_.front().centre;
}

std::uint32_t PaperHierarchy::build(Builder& builder, std::size_t begin, std::size_t end) {
  // A list of ranges instead of recursion: splits by the mean can be as uneven as the mesh is.
  struct Range {
    std::size_t begin, end;
    std::uint32_t node;
  };
  nodes_.push_back({});
  std::vector<Range> open{{begin, end, 0}};
  while (!open.empty()) {
    const Range range = open.back();
    open.pop_back();
    Node node{};
    setBounds(builder, node, range.begin, range.end);
    if (range.end - range.begin == 1) {
      node.triangle = builder.triangles[range.begin];
      nodes_[range.node] = node;
      continue;
    }
    // setBounds left the split's axis and place in `scratch`.
    const glm::dvec3 axis = builder.scratch[0], mean = builder.scratch[1];
    const auto first = builder.triangles.begin();
    const auto from = first + static_cast<std::ptrdiff_t>(range.begin),
               to = first + static_cast<std::ptrdiff_t>(range.end);
    auto middle = std::partition(from, to, [&](std::uint32_t t) {
      return glm::dot(axis, builder.centroids[t]) <= glm::dot(axis, mean);
    });
    // As PQP: where all are on one side, half of them as they come.
    if (middle == from || middle == to) middle = from + (to - from) / 2;
    const auto at = static_cast<std::size_t>(middle - first);
    node.left = static_cast<std::uint32_t>(nodes_.size());
    node.right = node.left + 1;
    nodes_[range.node] = node;
    nodes_.push_back({});
    nodes_.push_back({});
    open.push_back({range.begin, at, node.left});
    open.push_back({at, range.end, node.right});
  }
  return 0;
}

void PaperHierarchy::setBounds(Builder& builder, Node& node, std::size_t begin, std::size_t end) {
  const auto points = mesh_.vertices();
  const auto eachTriangle = [&](auto&& visit) {
    for (std::size_t i = begin; i < end; ++i)
      visit(builder.triangles[i]);
  };
  const auto eachCorner = [&](auto&& visit) {
    eachTriangle([&](std::uint32_t t) {
      for (const std::uint32_t corner : mesh_.triangles()[t])
        visit(points[corner]);
    });
  };
  // Mean and covariance over the corners of all triangles, as PQP takes them.
  glm::dvec3 mean(0.0);
  eachCorner([&](const glm::dvec3& p) { mean += p; });
  mean /= 3.0 * static_cast<double>(end - begin);
  glm::dmat3 covariance(0.0);
  eachCorner([&](const glm::dvec3& p) { covariance += glm::outerProduct(p - mean, p - mean); });
  const glm::dmat3 axes = axesOf(covariance);
  glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
  eachCorner([&](const glm::dvec3& p) {
    const glm::dvec3 local = (p - mean) * axes;
    lower = glm::min(lower, local);
    upper = glm::max(upper, local);
  });
  node.centre = mean + axes * (0.5 * (lower + upper));
  node.radius = 0.0;
  eachCorner(
      [&](const glm::dvec3& p) { node.radius = std::max(node.radius, glm::distance(p, node.centre)); });

  const auto eachNormal = [&](auto&& visit) {
    eachTriangle([&](std::uint32_t t) {
      visit(faceNormals_[t]);
      for (const std::uint32_t corner : mesh_.triangles()[t]) {
        visit(vertexNormals_[corner]);
        if (rule_ != PaperRule::NormalSpans) continue;
        for (const std::uint32_t other : facesAt(corner))
          visit(faceNormals_[other]);
      }
    });
  };
  node.axis = {0.0, 0.0, 1.0};
  node.cosHalf = -1.0;
  node.sinHalf = 0.0;
  if (rule_ != PaperRule::AllPairs) {
    glm::dvec3 sum(0.0);
    bool hasAll = true;
    eachNormal([&](const glm::dvec3& n) {
      sum += n;
      hasAll = hasAll && n != glm::dvec3(0.0);
    });
    const double length = glm::length(sum);
    // Where a normal is missing, or they cancel, nothing is known of directions.
    if (hasAll && length > kSameNormal) {
      node.axis = sum / length;
      double leastCosine = 1.0;
      eachNormal([&](const glm::dvec3& n) { leastCosine = std::min(leastCosine, glm::dot(n, node.axis)); });
      node.cosHalf = std::max(leastCosine, -1.0);
      node.sinHalf = std::sqrt(std::max(0.0, 1.0 - node.cosHalf * node.cosHalf));
    }
  }
  builder.scratch.assign({axes[0], mean});
}

std::span<const std::uint32_t> PaperHierarchy::facesAt(std::uint32_t vertex) const noexcept {
  return std::span(vertexFaces_).subspan(firstFace_[vertex], firstFace_[vertex + 1] - firstFace_[vertex]);
}

std::size_t PaperHierarchy::byteSize() const noexcept {
  return nodes_.size() * sizeof(Node) + (faceNormals_.size() + vertexNormals_.size()) * sizeof(glm::dvec3) +
         (vertexFaces_.size() + firstFace_.size()) * sizeof(std::uint32_t);
}

PaperFeature PaperHierarchy::featureAt(std::uint32_t triangle, std::uint8_t place) const noexcept {
  if (place < 3) return {PaperFeature::Kind::Vertex, mesh_.triangles()[triangle][place]};
  if (place < 6) return {PaperFeature::Kind::Edge, mesh_.edgesOfTriangle(triangle)[place - 3U]};
  return {PaperFeature::Kind::Face, triangle};
}

bool PaperHierarchy::isInSpanOf(const PaperFeature& feature, const glm::dvec3& direction) const {
  if (feature.kind == PaperFeature::Kind::Face)
    return isInSpan(direction, std::span(&faceNormals_[feature.index], 1));
  const auto faces =
      feature.kind == PaperFeature::Kind::Edge ? mesh_.facesOfEdge(feature.index) : facesAt(feature.index);
  std::vector<glm::dvec3> normals;
  for (const std::uint32_t t : faces)
    normals.push_back(faceNormals_[t]);
  return isInSpan(direction, normals);
}

std::span<const PaperMinimum> PaperQuery::find(const RigidTransform& sceneFromPart, double cutoff) {
  const Posed pose{glm::mat3_cast(sceneFromPart.rotation), sceneFromPart.translation, cutoff};
  const auto sceneNodes = scene_.nodes(), partNodes = part_.nodes();
  found_.clear();
  nodePairs_ = leafPairs_ = 0;
  isTouching_ = false;
  stack_.clear();
  if (!sceneNodes.empty() && !partNodes.empty()) stack_.emplace_back(0, 0);
  while (!stack_.empty()) {
    const auto [i, j] = stack_.back();
    stack_.pop_back();
    ++nodePairs_;
    const PaperHierarchy::Node &a = sceneNodes[i], &b = partNodes[j];
    if (isPruned(a, b, pose)) continue;
    if (a.isLeaf() && b.isLeaf()) {
      testLeaves(a.triangle, b.triangle, a, b, pose);
    } else if (b.isLeaf() || (!a.isLeaf() && a.radius >= b.radius)) {
      stack_.emplace_back(a.left, j);
      stack_.emplace_back(a.right, j);
    } else {
      stack_.emplace_back(i, b.left);
      stack_.emplace_back(i, b.right);
    }
  }
  const auto features = [](const PaperMinimum& m) { return std::tie(m.sceneFeature, m.partFeature); };
  if (scene_.rule() != PaperRule::AllPairs) {
    std::sort(found_.begin(), found_.end(), [&](const PaperMinimum& l, const PaperMinimum& r) {
      return std::tuple(features(l), l.distance) < std::tuple(features(r), r.distance);
    });
    found_.erase(
        std::unique(found_.begin(), found_.end(),
                    [&](const PaperMinimum& l, const PaperMinimum& r) { return features(l) == features(r); }),
        found_.end());
  }
  std::sort(found_.begin(), found_.end(),
            [](const PaperMinimum& l, const PaperMinimum& r) { return l.distance < r.distance; });
  return found_;
}

bool PaperQuery::isPruned(const PaperHierarchy::Node& a, const PaperHierarchy::Node& b,
                          const Posed& pose) const noexcept {
  const glm::dvec3 between = pose.rotation * b.centre + pose.translation - a.centre;
  const double distance = glm::length(between), radii = (a.radius + b.radius) * (1.0 + kPruningPad);
  if (distance - radii > pose.cutoff) return true;
  if (scene_.rule() == PaperRule::AllPairs) return false;
  const glm::dvec3 axisOfB = pose.rotation * b.axis;
  const Angle halfA = halfAngleOf(a), halfB = halfAngleOf(b);
  if (isBeyond(-glm::dot(a.axis, axisOfB), halfA, halfB)) return true;
  if (distance <= radii) return false;
  const double sine = radii / distance;
  const Angle span{std::sqrt(std::max(0.0, 1.0 - sine * sine)), sine};
  return isBeyond(glm::dot(a.axis, between) / distance, halfA, span) ||
         isBeyond(-glm::dot(axisOfB, between) / distance, halfB, span);
}

void PaperQuery::testLeaves(std::uint32_t a, std::uint32_t b, const PaperHierarchy::Node& leafA,
                            const PaperHierarchy::Node& leafB, const Posed& pose) {
  ++leafPairs_;
  glm::dvec3 cornersA[3], cornersB[3];
  for (std::size_t k = 0; k < 3; ++k) {
    cornersA[k] = scene_.mesh().vertices()[scene_.mesh().triangles()[a][k]];
    cornersB[k] = pose.rotation * part_.mesh().vertices()[part_.mesh().triangles()[b][k]] + pose.translation;
  }
  if (isApart(cornersA, cornersB, pose.cutoff) || isApart(cornersB, cornersA, pose.cutoff)) return;
  const TrianglesNear near = nearestOf(cornersA, cornersB);
  if (!(near.distance > 0.0)) {
    isTouching_ = true;
    return;
  }
  if (near.distance > pose.cutoff) return;
  PaperMinimum minimum{
      scene_.featureAt(a, near.placeOnA), part_.featureAt(b, near.placeOnB), near.a, near.b, near.distance,
      (near.b - near.a) / near.distance};
  if (scene_.rule() == PaperRule::AllPairs) {
    minimum.sceneFeature = {PaperFeature::Kind::Face, a};
    minimum.partFeature = {PaperFeature::Kind::Face, b};
  } else if (!isAccepted(minimum, leafA, leafB, pose)) {
    return;
  }
  found_.push_back(minimum);
}

bool PaperQuery::isAccepted(const PaperMinimum& minimum, const PaperHierarchy::Node& leafA,
                            const PaperHierarchy::Node& leafB, const Posed& pose) const {
  const glm::dvec3 toScene = glm::transpose(pose.rotation) * -minimum.direction;  // In the part's frame.
  if (!isInCone(minimum.direction, leafA) || !isInCone(toScene, leafB)) return false;
  return scene_.rule() == PaperRule::NormalCones ||
         (scene_.isInSpanOf(minimum.sceneFeature, minimum.direction) &&
          part_.isInSpanOf(minimum.partFeature, toScene));
}

}  // namespace nearfit::bench
