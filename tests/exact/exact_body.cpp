#include "tests/exact/exact_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <glm/geometric.hpp>

namespace nearfit::test::exact {

double nearest(const Number& x) {
  return CGAL::to_double(x.exact());
}
glm::dvec3 nearest(const Vector& v) {
  return {nearest(v.x()), nearest(v.y()), nearest(v.z())};
}
double lengthOf(const Vector& v) {
  return std::sqrt(CGAL::to_double(v.squared_length()));
}

namespace {

glm::dvec3 rough(const Vector& v) {
  return {CGAL::to_double(v.x()), CGAL::to_double(v.y()), CGAL::to_double(v.z())};
}
glm::dvec3 roughUnit(const Vector& v) {
  const double length = lengthOf(v);
  return length > 0.0 ? rough(v) / length : glm::dvec3(0.0);
}

/// Faces around a vertex hang together through edges at it: one closed fan.
bool isOneFan(const std::vector<std::uint32_t>& faces,
              const std::vector<const std::vector<std::uint32_t>*>& facesOfEdges) {
  std::set<std::uint32_t> reached{faces[0]};
  for (bool grew = true; grew;) {
    grew = false;
    for (const auto* around : facesOfEdges) {
      const bool touches =
          std::any_of(around->begin(), around->end(), [&](auto f) { return reached.contains(f); });
      for (const std::uint32_t f : *around)
        grew = (touches && reached.insert(f).second) || grew;
    }
  }
  return reached.size() == faces.size();
}

}  // namespace

Body::Body(const TriangleMesh& mesh)
    : positions_(mesh.vertices().begin(), mesh.vertices().end()),
      triangles_(mesh.triangles().begin(), mesh.triangles().end()) {
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  std::map<Pair, std::vector<std::uint32_t>> facesOfEdge;
  std::map<Pair, int> runs;
  std::map<std::uint32_t, std::vector<std::uint32_t>> facesOfVertex;
  std::map<std::uint32_t, std::set<std::uint32_t>> neighbours;
  glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper(-lower);
  for (std::uint32_t f = 0; f < triangles_.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles_[f][k], b = triangles_[f][(k + 1) % 3];
      facesOfEdge[std::minmax(a, b)].push_back(f);
      ++runs[{a, b}];
      facesOfVertex[a].push_back(f);
      neighbours[a].insert(b);
      neighbours[b].insert(a);
      lower = glm::min(lower, positions_[a]);
      upper = glm::max(upper, positions_[a]);
    }
  }
  size_ = glm::distance(lower, upper);
  for (const auto& [e, faces] : facesOfEdge) {
    const bool isConsistent = faces.size() == 2 && runs[{e.first, e.second}] == 1;
    edges_.push_back({e.first, e.second, faces, isConsistent && runs[{e.second, e.first}] == 1});
  }
  std::map<Pair, const EdgeTopology*> byEnds;
  for (const EdgeTopology& e : edges_)
    byEnds[{e.v0, e.v1}] = &e;
  for (const auto& [v, others] : neighbours) {
    VertexTopology vertex{v, {others.begin(), others.end()}, facesOfVertex[v], true};
    std::vector<const std::vector<std::uint32_t>*> around;
    for (const std::uint32_t n : others) {
      const EdgeTopology* e = byEnds[std::minmax(v, n)];
      vertex.isClosedFan = vertex.isClosedFan && e->isConsistent;
      around.push_back(&e->faces);
    }
    vertex.isClosedFan = vertex.isClosedFan && isOneFan(vertex.faces, around);
    vertices_.push_back(std::move(vertex));
  }
}

/// The body's points at a pose, and the features made of them.
class Body::Posed {
 public:
  Posed(const Body& body, const RigidTransform& pose) : body_(body) {
    const glm::dquat& q = pose.rotation;
    const Number w = q.w, x = q.x, y = q.y, z = q.z, two = 2;
    const Number scale = two / (w * w + x * x + y * y + z * z);
    const Vector rows[3] = {{1 - scale * (y * y + z * z), scale * (x * y - w * z), scale * (x * z + w * y)},
                            {scale * (x * y + w * z), 1 - scale * (x * x + z * z), scale * (y * z - w * x)},
                            {scale * (x * z - w * y), scale * (y * z + w * x), 1 - scale * (x * x + y * y)}};
    const bool isTurned = q.x != 0.0 || q.y != 0.0 || q.z != 0.0;
    for (const glm::dvec3& p : body.positions_) {
      const Vector v(p.x, p.y, p.z);
      const Vector turned = isTurned ? Vector(rows[0] * v, rows[1] * v, rows[2] * v) : v;
      points_.push_back(Point(pose.translation.x, pose.translation.y, pose.translation.z) + turned);
    }
    for (const Triangle& t : body.triangles_) {
      normals_.push_back(CGAL::cross_product(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]));
      hasArea_.push_back(normals_.back() != CGAL::NULL_VECTOR);
    }
  }

  std::vector<Feature> features() {
    for (std::uint32_t f = 0; f < body_.triangles_.size(); ++f)
      addFace(f);
    for (const EdgeTopology& e : body_.edges_)
      addEdge(e);
    for (const VertexTopology& v : body_.vertices_)
      addVertex(v);
    return std::move(out_);
  }

 private:
  Feature& add(char kind, std::initializer_list<std::uint32_t> corners) {
    Feature feature;
    feature.kind = kind;
    feature.lower = glm::dvec3(std::numeric_limits<double>::infinity());
    feature.upper = -feature.lower;
    for (const std::uint32_t c : corners) {
      feature.corners.push_back(points_[c]);
      const glm::dvec3 p = rough(points_[c] - CGAL::ORIGIN);
      feature.lower = glm::min(feature.lower, p);
      feature.upper = glm::max(feature.upper, p);
    }
    out_.push_back(std::move(feature));
    return out_.back();
  }

  void addFace(std::uint32_t f) {
    if (!hasArea_[f]) return;
    const Triangle& t = body_.triangles_[f];
    Feature& face = add('f', {t[0], t[1], t[2]});
    face.span = normals_[f];
    double longest = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      longest = std::max(longest, lengthOf(face.corners[(k + 1) % 3] - face.corners[k]));
    face.height = lengthOf(face.span) / longest;
    face.hasSide = true;
  }

  void addEdge(const EdgeTopology& e) {
    if (points_[e.v0] == points_[e.v1]) return;
    Feature& edge = add('e', {e.v0, e.v1});
    edge.span = points_[e.v1] - points_[e.v0];
    edge.height = lengthOf(edge.span);
    const Number squared = edge.span.squared_length();
    std::vector<std::uint32_t> faces;
    for (const std::uint32_t f : e.faces) {
      if (!hasArea_[f]) continue;
      faces.push_back(f);
      for (const std::uint32_t c : body_.triangles_[f]) {
        if (c == e.v0 || c == e.v1) continue;
        const Vector w = points_[c] - points_[e.v0], t = w - edge.span * (w * edge.span / squared);
        edge.tangents.push_back({t, lengthOf(t)});
      }
    }
    if (faces.empty()) {
      out_.pop_back();
      return;
    }
    edge.hasSide = e.isConsistent && faces.size() == 2;
    if (!edge.hasSide) return;
    const Vector &t0 = edge.tangents[0].vector, &t1 = edge.tangents[1].vector, &n0 = normals_[faces[0]];
    edge.convexity = -CGAL::to_double(t1 * n0) / (edge.tangents[1].length * lengthOf(n0));
    edge.isFolded = t0 * t1 > 0;
    edge.outward = roughUnit(n0) + roughUnit(normals_[faces[1]]);
  }

  void addVertex(const VertexTopology& v) {
    Feature& vertex = add('v', {v.vertex});
    vertex.hasSide = v.isClosedFan;
    std::set<std::uint32_t> joined;  // By a face with an area: the others are no surface.
    for (const std::uint32_t f : v.faces) {
      if (hasArea_[f]) joined.insert(body_.triangles_[f].begin(), body_.triangles_[f].end());
    }
    joined.erase(v.vertex);
    if (joined.empty()) {
      out_.pop_back();
      return;
    }
    for (const std::uint32_t n : joined) {
      const Vector e = points_[n] - points_[v.vertex];
      vertex.tangents.push_back({e, lengthOf(e)});
    }
    for (const std::uint32_t f : v.faces) {
      const Triangle& t = body_.triangles_[f];
      const std::size_t k = t[0] == v.vertex ? 0 : t[1] == v.vertex ? 1 : 2;
      const Vector a = points_[t[(k + 1) % 3]] - points_[v.vertex],
                   b = points_[t[(k + 2) % 3]] - points_[v.vertex];
      if (!hasArea_[f]) continue;
      const double angle = std::acos(std::clamp(glm::dot(roughUnit(a), roughUnit(b)), -1.0, 1.0));
      vertex.outward += angle * roughUnit(normals_[f]);
      vertex.fan.push_back({a, b});
    }
  }

  const Body& body_;
  std::vector<Point> points_;
  std::vector<Vector> normals_;
  std::vector<bool> hasArea_;
  std::vector<Feature> out_;
};

std::vector<Feature> Body::features(const RigidTransform& pose) const {
  return Posed(*this, pose).features();
}

}  // namespace nearfit::test::exact
