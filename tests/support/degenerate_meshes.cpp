#include "tests/support/degenerate_meshes.h"

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/support/portable_random.h"

namespace nearfit::test {
namespace {

/// A mesh that is being spoilt.
struct EditableMesh {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;

  explicit EditableMesh(const TriangleMesh& mesh)
      : vertices(mesh.vertices().begin(), mesh.vertices().end()),
        triangles(mesh.triangles().begin(), mesh.triangles().end()) {}
  std::uint32_t add(const glm::dvec3& p) {
    vertices.push_back(p);
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
  /// Splits a face at a point.
  void split(std::size_t face, const glm::dvec3& p) {
    const Triangle t = triangles[face];
    const std::uint32_t v = add(p);
    triangles[face] = {t[0], t[1], v};
    triangles.push_back({t[1], t[2], v});
    triangles.push_back({t[2], t[0], v});
  }
  TriangleMesh finish() { return {std::move(vertices), std::move(triangles)}; }
};

glm::dvec3 normalOf(const EditableMesh& draft, const Triangle& t) {
  return glm::normalize(
      glm::cross(draft.vertices[t[1]] - draft.vertices[t[0]], draft.vertices[t[2]] - draft.vertices[t[0]]));
}

}  // namespace

TriangleMesh withSlivers(const TriangleMesh& mesh, double aspect, double lift) {
  EditableMesh draft(mesh);
  for (std::size_t f = 0; f < mesh.triangles().size(); ++f) {
    const Triangle& t = mesh.triangles()[f];
    const glm::dvec3 a = draft.vertices[t[0]], b = draft.vertices[t[1]], n = normalOf(draft, t);
    const double away = glm::distance(a, b) / aspect;
    const glm::dvec3 inward = glm::normalize(glm::cross(n, b - a));
    draft.split(f, 0.45 * a + 0.55 * b + away * inward + lift * away * n);
  }
  return draft.finish();
}

TriangleMesh withNeedles(const TriangleMesh& mesh, double aspect, double lift) {
  EditableMesh draft(mesh);
  for (std::size_t f = 0; f < mesh.triangles().size(); ++f) {
    const Triangle& t = mesh.triangles()[f];
    const glm::dvec3 a = draft.vertices[t[0]], b = draft.vertices[t[1]], c = draft.vertices[t[2]];
    const glm::dvec3 way = (0.4 * b + 0.6 * c - a) / aspect;
    draft.split(f, a + way + lift * glm::length(way) * normalOf(draft, t));
  }
  return draft.finish();
}

glm::dvec3 inSinglePrecision(const glm::dvec3& point) {
  // GCC 12 takes narrowing and widening of two coordinates at a time for nothing, unless each is stored.
  const auto rounded = [](double x) {
    volatile float single = static_cast<float>(x);
    return static_cast<double>(single);
  };
  return {rounded(point.x), rounded(point.y), rounded(point.z)};
}

TriangleMesh inSinglePrecision(const TriangleMesh& mesh) {
  EditableMesh draft(mesh);
  for (glm::dvec3& p : draft.vertices)
    p = inSinglePrecision(p);
  return draft.finish();
}

TriangleMesh withDuplicates(const TriangleMesh& mesh) {
  EditableMesh draft(mesh);
  for (std::size_t f = 0; f < mesh.triangles().size(); f += 3) {
    const Triangle& t = mesh.triangles()[f];
    draft.triangles.push_back(f % 6 == 0 ? Triangle{t[0], t[2], t[1]} : Triangle{t[1], t[2], t[0]});
  }
  return draft.finish();
}

TriangleMesh withFacesWithoutArea(const TriangleMesh& mesh) {
  EditableMesh draft(mesh);
  for (std::size_t e = 0; e < mesh.edges().size(); e += 2) {
    const MeshEdge& edge = mesh.edges()[e];
    const glm::dvec3 a = draft.vertices[edge.v0], b = draft.vertices[edge.v1];
    // A middle that is exact only where coordinates allow: nearly without area elsewhere, which is another
    // case; so on the line by construction, at an end.
    const std::uint32_t end = draft.add(e % 4 == 0 ? a : b);
    draft.triangles.push_back({edge.v0, edge.v1, end});
  }
  for (std::uint32_t v = 0; v < mesh.vertices().size(); v += 3) {
    const std::uint32_t one = draft.add(draft.vertices[v]), other = draft.add(draft.vertices[v]);
    draft.triangles.push_back({v, one, other});
  }
  return draft.finish();
}

TriangleMesh jaggedFan(std::uint64_t seed, std::uint32_t valence, double height) {
  std::mt19937_64 random(seed);
  std::vector<glm::dvec3> x{glm::dvec3(0.0)};
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < valence; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / valence, radius = 0.5 + 0.5 * uniform(random);
    x.push_back({radius * std::cos(angle), radius * std::sin(angle), height * (2.0 * uniform(random) - 1.0)});
    t.push_back({0, 1 + i, 1 + (i + 1) % valence});
  }
  return {std::move(x), std::move(t)};
}

TriangleMesh wedgeMesh(double halfAngle) {
  const double x = std::sin(halfAngle), z = -std::cos(halfAngle);
  return {{{0, -1, 0}, {0, 1, 0}, {x, -1, z}, {x, 1, z}, {-x, -1, z}, {-x, 1, z}},
          {{0, 2, 3}, {0, 3, 1}, {0, 1, 5}, {0, 5, 4}, {0, 4, 2}, {1, 3, 5}, {2, 4, 5}, {2, 5, 3}}};
}

TriangleMesh coplanarFans(std::uint64_t seed, std::uint32_t cells) {
  std::mt19937_64 random(seed);
  const double side = cells;
  std::vector<glm::dvec3> x{{0, 0, 0},  {side, 0, 0},  {side, side, 0},  {0, side, 0},
                            {0, 0, -1}, {side, 0, -1}, {side, side, -1}, {0, side, -1}};
  std::vector<Triangle> t{{4, 6, 5}, {4, 7, 6}, {0, 4, 5}, {0, 5, 1}, {1, 5, 6},
                          {1, 6, 2}, {2, 6, 7}, {2, 7, 3}, {3, 7, 4}, {3, 4, 0}};
  std::vector<Triangle> top{{0, 1, 2}, {0, 2, 3}};
  for (int i = 0; i < 400 && top.size() < 60; ++i) {
    const glm::dvec3 p(static_cast<double>(random() % cells), static_cast<double>(random() % cells), 0.0);
    for (std::size_t f = 0; f < top.size(); ++f) {
      const Triangle c = top[f];
      const auto turn = [&](std::size_t k) { return glm::cross(x[c[(k + 1) % 3]] - x[c[k]], p - x[c[k]]).z; };
      if (!(turn(0) > 0.0 && turn(1) > 0.0 && turn(2) > 0.0)) continue;
      const auto v = static_cast<std::uint32_t>(x.size());
      x.push_back(p);
      top[f] = {c[0], c[1], v};
      top.push_back({c[1], c[2], v});
      top.push_back({c[2], c[0], v});
      break;
    }
  }
  t.insert(t.end(), top.begin(), top.end());
  for (glm::dvec3& p : x)
    p /= side;
  return {std::move(x), std::move(t)};
}

TriangleMesh prismOver(const std::vector<glm::dvec2>& curve, const glm::dvec2& middle) {
  const auto n = static_cast<std::uint32_t>(curve.size());
  std::vector<glm::dvec3> vertices;
  for (const glm::dvec2& p : curve)
    vertices.emplace_back(p, -0.5);
  for (const glm::dvec2& p : curve)
    vertices.emplace_back(p, 0.5);
  vertices.emplace_back(middle, -0.5);
  vertices.emplace_back(middle, 0.5);
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    triangles.push_back({i, next, n + next});
    triangles.push_back({i, n + next, n + i});
    triangles.push_back({2 * n, next, i});
    triangles.push_back({2 * n + 1, n + i, n + next});
  }
  return TriangleMesh(std::move(vertices), std::move(triangles));
}

TriangleMesh figureOfEightMesh(double scale) {
  return prismOver({{1.0, -1.0}, {1.0, 1.0}, {-scale, -scale}, {-scale, scale}}, {2.0 / 3.0, 0.0});
}

TriangleMesh finsMesh(std::uint64_t seed, std::uint32_t fins, double spread) {
  std::mt19937_64 random(seed);
  std::vector<glm::dvec3> x{{0, 0, -0.5}, {0, 0, 0.5}};
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < fins; ++i) {
    const double angle = spread * uniform(random), height = uniform(random) - 0.5;
    x.push_back({std::cos(angle), std::sin(angle), height});
    t.push_back(random() % 2 == 0 ? Triangle{0, 1, 2 + i} : Triangle{1, 0, 2 + i});
  }
  return {std::move(x), std::move(t)};
}

TriangleMesh looseTriangles(std::uint64_t seed, std::uint32_t count) {
  std::mt19937_64 random(seed);
  std::vector<glm::dvec3> x;
  std::vector<Triangle> t;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 middle{uniform(random), uniform(random), uniform(random)};
    for (int k = 0; k < 3; ++k)
      x.push_back(middle + 0.4 * glm::dvec3{uniform(random), uniform(random), uniform(random)});
    t.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return {std::move(x), std::move(t)};
}

TriangleMesh crossedApexMesh() {
  std::vector<glm::dvec3> vertices{{9, -1.5, -1}, {9, 1.5, -1}, {-1, -1, -1},
                                   {-1, 1, -1},   {0, 0, 0},    {0, 0, -3}};
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t next = (i + 1) % 4;
    triangles.push_back({4, i, next});
    triangles.push_back({5, next, i});
  }
  return TriangleMesh(std::move(vertices), std::move(triangles));
}

}  // namespace nearfit::test
