#include "tests/support/lmd_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include <glm/geometric.hpp>

namespace nearfit::test {
namespace {

using Feature = OracleBody::Feature;
using Pair = std::pair<std::uint32_t, std::uint32_t>;

glm::dvec3 triangleNormal(const std::vector<glm::dvec3>& c) {
  const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
  const double length = glm::length(n);
  return length > 0.0 ? n / length : glm::dvec3(0.0);
}

/// From the line through a and b to c, perpendicular to it.
glm::dvec3 perpendicularTo(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 e = b - a;
  const glm::dvec3 t = (c - a) - e * (glm::dot(c - a, e) / glm::dot(e, e));
  return t / glm::length(t);
}

struct Box {
  glm::dvec3 lower{std::numeric_limits<double>::infinity()}, upper{-std::numeric_limits<double>::infinity()};
  void add(const glm::dvec3& p) {
    lower = glm::min(lower, p);
    upper = glm::max(upper, p);
  }
};

Box boxOf(const Feature& f) {
  Box b;
  for (const glm::dvec3& c : f.corners)
    b.add(c);
  return b;
}

bool apart(const Box& a, const Box& b, double gap) {
  return a.lower.x > b.upper.x + gap || b.lower.x > a.upper.x + gap || a.lower.y > b.upper.y + gap ||
         b.lower.y > a.upper.y + gap || a.lower.z > b.upper.z + gap || b.lower.z > a.upper.z + gap;
}

/// Where the spans of two features come nearest: coordinates of the two points, and how far inside the
/// features they are (least over all sides, as a length). False for parallel spans.
bool criticalPoints(const Feature& a, const Feature& b, glm::dvec3& p, glm::dvec3& q, double& inside) {
  inside = std::numeric_limits<double>::infinity();
  const auto onSegment = [&inside](const Feature& edge, double s) {
    const double length = glm::distance(edge.corners[0], edge.corners[1]);
    inside = std::min({inside, s * length, (1.0 - s) * length});
    return edge.corners[0] + s * (edge.corners[1] - edge.corners[0]);
  };
  const auto footOnEdge = [&](const Feature& edge, const glm::dvec3& x) {
    const glm::dvec3 e = edge.corners[1] - edge.corners[0];
    return onSegment(edge, glm::dot(x - edge.corners[0], e) / glm::dot(e, e));
  };
  const auto footOnFace = [&](const Feature& face, const glm::dvec3& x) {
    const glm::dvec3 n = triangleNormal(face.corners);
    const glm::dvec3 foot = x - n * glm::dot(x - face.corners[0], n);
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 &c0 = face.corners[k], &c1 = face.corners[(k + 1) % 3],
                       &c2 = face.corners[(k + 2) % 3];
      inside = std::min(inside, glm::dot(foot - c0, perpendicularTo(c0, c1, c2)));
    }
    return foot;
  };
  p = a.corners[0];
  q = b.corners[0];
  if (a.kind == 'v' && b.kind == 'v') return true;
  if (a.kind == 'v' && b.kind == 'e') return q = footOnEdge(b, p), true;
  if (a.kind == 'e' && b.kind == 'v') return p = footOnEdge(a, q), true;
  if (a.kind == 'v' && b.kind == 'f') return q = footOnFace(b, p), true;
  if (a.kind == 'f' && b.kind == 'v') return p = footOnFace(a, q), true;
  if (a.kind != 'e' || b.kind != 'e') return false;
  // Normal equations of |a0 + s u - b0 - t v|^2.
  const glm::dvec3 u = a.corners[1] - a.corners[0], v = b.corners[1] - b.corners[0],
                   w = b.corners[0] - a.corners[0];
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v), uw = glm::dot(u, w),
               vw = glm::dot(v, w);
  const double determinant = uu * vv - uv * uv;
  constexpr double kParallel = 1e-14;
  if (!(determinant > kParallel * uu * vv)) return false;
  p = onSegment(a, (vv * uw - uv * vw) / determinant);
  q = onSegment(b, (uv * uw - uu * vw) / determinant);
  return true;
}

}  // namespace

OracleBody::OracleBody(const TriangleMesh& mesh) {
  const auto x = mesh.vertices();
  std::map<Pair, std::vector<std::uint32_t>> facesOfEdge;
  std::map<Pair, int> runs;  // Times that faces run along a directed edge.
  std::map<std::uint32_t, std::set<std::uint32_t>> neighbours;
  std::map<std::uint32_t, std::vector<std::uint32_t>> facesOfVertex;
  Box box;
  for (std::uint32_t f = 0; f < mesh.triangles().size(); ++f) {
    const Triangle& t = mesh.triangles()[f];
    features_.push_back({'f', {x[t[0]], x[t[1]], x[t[2]]}, {}, {}});
    features_.back().outward = triangleNormal(features_.back().corners);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      facesOfEdge[std::minmax(a, b)].push_back(f);
      ++runs[{a, b}];
      neighbours[a].insert(b);
      neighbours[b].insert(a);
      facesOfVertex[a].push_back(f);
      box.add(x[a]);
    }
  }
  size_ = glm::distance(box.lower, box.upper);
  const auto normal = [&](std::uint32_t f) { return features_[f].outward; };
  const auto hasSide = [&](const Pair& e) {
    return facesOfEdge[e].size() == 2 && runs[{e.first, e.second}] == 1 && runs[{e.second, e.first}] == 1;
  };
  for (const auto& [e, faces] : facesOfEdge) {
    Feature edge{'e', {x[e.first], x[e.second]}, {}, {}};
    for (const std::uint32_t f : faces) {
      for (const std::uint32_t c : mesh.triangles()[f]) {
        if (c != e.first && c != e.second)
          edge.tangents.push_back(perpendicularTo(x[e.first], x[e.second], x[c]));
      }
    }
    if (hasSide(e)) edge.outward = normal(faces[0]) + normal(faces[1]);
    features_.push_back(edge);
  }
  for (const auto& [v, others] : neighbours) {
    Feature vertex{'v', {x[v]}, {}, {}};
    bool sided = true;
    for (const std::uint32_t n : others) {
      vertex.tangents.push_back((x[n] - x[v]) / glm::distance(x[n], x[v]));
      sided = sided && hasSide(std::minmax(v, n));
    }
    // One fan: its faces are joined through edges at v.
    std::set<std::uint32_t> reached{facesOfVertex[v][0]};
    for (bool grew = true; grew;) {
      grew = false;
      for (const std::uint32_t n : others) {
        const auto& faces = facesOfEdge[std::minmax(v, n)];
        const bool touches =
            std::any_of(faces.begin(), faces.end(), [&](auto f) { return reached.contains(f); });
        for (const std::uint32_t f : faces)
          grew = (touches && reached.insert(f).second) || grew;
      }
    }
    sided = sided && reached.size() == facesOfVertex[v].size();
    for (const std::uint32_t f : facesOfVertex[v]) {
      if (!sided) break;
      const Triangle& t = mesh.triangles()[f];
      const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const glm::dvec3 a = glm::normalize(x[t[(k + 1) % 3]] - x[v]),
                       b = glm::normalize(x[t[(k + 2) % 3]] - x[v]);
      vertex.outward += std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)) * normal(f);
    }
    features_.push_back(vertex);
  }
}

OracleBody::Feature moved(const OracleBody::Feature& feature, const RigidTransform& pose) {
  OracleBody::Feature out = feature;
  for (glm::dvec3& corner : out.corners)
    corner = pose.applyToPoint(corner);
  for (glm::dvec3& tangent : out.tangents)
    tangent = pose.applyToVector(tangent);
  out.outward = pose.applyToVector(out.outward);
  return out;
}

std::vector<OracleMinimum> bruteForceMinima(const OracleBody& scene, const OracleBody& part,
                                            const RigidTransform& sceneFromPart, double cutoff,
                                            double margin) {
  struct Entry {
    const Feature* feature;
    Box box;
  };
  std::vector<Entry> entries;
  Box all;
  for (const Feature& f : scene.features()) {
    entries.push_back({&f, boxOf(f)});
    all.add(entries.back().box.lower);
    all.add(entries.back().box.upper);
  }
  // Sorted along the axis on which boxes are shortest for the whole; entries that begin farther left than the
  // widest of them cannot reach.
  glm::dvec3 longest(0.0);
  for (const Entry& e : entries)
    longest = glm::max(longest, e.box.upper - e.box.lower);
  const glm::dvec3 window = (longest + cutoff) / glm::max(all.upper - all.lower, glm::dvec3(cutoff));
  const int axis = window.x <= window.y && window.x <= window.z ? 0 : window.y <= window.z ? 1 : 2;
  const double widest = longest[axis];
  std::sort(entries.begin(), entries.end(),
            [axis](const Entry& l, const Entry& r) { return l.box.lower[axis] < r.box.lower[axis]; });

  const double size = scene.size() + part.size();
  std::vector<OracleMinimum> found;
  for (const Feature& local : part.features()) {
    const Feature b = moved(local, sceneFromPart);
    const Box box = boxOf(b);
    if (apart(box, all, cutoff)) continue;
    auto it = std::lower_bound(entries.begin(), entries.end(), box.lower[axis] - cutoff - widest,
                               [axis](const Entry& e, double x) { return e.box.lower[axis] < x; });
    for (; it != entries.end() && it->box.lower[axis] <= box.upper[axis] + cutoff; ++it) {
      if (apart(it->box, box, cutoff)) continue;
      OracleMinimum m;
      double inside;
      if (!criticalPoints(*it->feature, b, m.scenePoint, m.partPoint, inside)) continue;
      m.slack = inside / size;
      if (m.slack <= -margin) continue;
      m.distance = glm::distance(m.scenePoint, m.partPoint);
      if (!(m.distance > 0.0) || m.distance > cutoff) continue;
      const glm::dvec3 d = (m.partPoint - m.scenePoint) / m.distance;
      for (const glm::dvec3& t : it->feature->tangents)
        m.slack = std::min(m.slack, -glm::dot(d, t));
      for (const glm::dvec3& t : b.tangents)
        m.slack = std::min(m.slack, glm::dot(d, t));
      if (m.slack <= -margin) continue;
      const glm::dvec3 &out = it->feature->outward, &partOut = b.outward;
      if (out != glm::dvec3(0.0) && glm::dot(d, out) <= 0.0) continue;
      if (partOut != glm::dvec3(0.0) && glm::dot(-d, partOut) <= 0.0) continue;
      m.features = {it->feature->kind, b.kind};
      found.push_back(m);
    }
  }
  return found;
}

}  // namespace nearfit::test
