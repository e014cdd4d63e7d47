#include "tests/support/mesh_generators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/support/portable_random.h"

namespace nearfit::test {
namespace {

using std::numbers::pi;

/// A mesh under construction.
struct Draft {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;

  std::uint32_t add(const glm::dvec3& p) {
    vertices.push_back(p);
    return static_cast<std::uint32_t>(vertices.size() - 1);
  }
  void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { triangles.push_back({a, b, c}); }
  void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    addTriangle(a, b, c);
    addTriangle(a, c, d);
  }
  TriangleMesh finish() { return {std::move(vertices), std::move(triangles)}; }
};

/// Vertices on a circle about z, anticlockwise seen from +z; returns the index of the first.
std::uint32_t addRing(Draft& draft, double radius, double z, std::uint32_t segments) {
  const auto first = static_cast<std::uint32_t>(draft.vertices.size());
  for (std::uint32_t i = 0; i < segments; ++i) {
    const double angle = 2.0 * pi * i / segments;
    draft.add({radius * std::cos(angle), radius * std::sin(angle), z});
  }
  return first;
}

/// Quads between two rings; seen from outside the band, `upper` lies above `lower` and segments run to the
/// right.
void addBand(Draft& draft, std::uint32_t lower, std::uint32_t upper, std::uint32_t segments) {
  for (std::uint32_t i = 0; i < segments; ++i) {
    const std::uint32_t j = (i + 1) % segments;
    draft.addQuad(lower + i, lower + j, upper + j, upper + i);
  }
}

/// A fan from `tip` to a ring; the ring is anticlockwise seen from the side of the tip unless turned.
void addFan(Draft& draft, std::uint32_t tip, std::uint32_t ring, std::uint32_t segments, bool isTurned) {
  for (std::uint32_t i = 0; i < segments; ++i) {
    const std::uint32_t a = ring + i, b = ring + (i + 1) % segments;
    draft.addTriangle(tip, isTurned ? b : a, isTurned ? a : b);
  }
}

Draft icosahedron() {
  const double g = std::numbers::phi;
  Draft draft;
  draft.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  draft.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (glm::dvec3& p : draft.vertices)
    p = glm::normalize(p);
  return draft;
}

void subdivideOnUnitSphere(Draft& draft) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, isNew] = middles.try_emplace(std::minmax(a, b), 0);
    if (isNew) entry->second = draft.add(glm::normalize(draft.vertices[a] + draft.vertices[b]));
    return entry->second;
  };
  const std::vector<Triangle> coarse = std::exchange(draft.triangles, {});
  for (const Triangle& t : coarse) {
    const std::uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    draft.addTriangle(t[0], ab, ca);
    draft.addTriangle(ab, t[1], bc);
    draft.addTriangle(ca, bc, t[2]);
    draft.addTriangle(ab, bc, ca);
  }
}

Draft unitIcosphere(std::uint32_t subdivisions) {
  Draft draft = icosahedron();
  for (std::uint32_t i = 0; i < subdivisions; ++i)
    subdivideOnUnitSphere(draft);
  return draft;
}

}  // namespace

TriangleMesh tetrahedronMesh(double radius) {
  const double c = radius / std::sqrt(3.0);
  return {{{c, c, c}, {c, -c, -c}, {-c, c, -c}, {-c, -c, c}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

TriangleMesh boxMesh(const glm::dvec3& size, const glm::dvec3& centre) {
  Draft draft;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 side((i & 1) != 0 ? 0.5 : -0.5, (i & 2) != 0 ? 0.5 : -0.5, (i & 4) != 0 ? 0.5 : -0.5);
    draft.add(centre + side * size);
  }
  draft.addQuad(0, 2, 3, 1);
  draft.addQuad(4, 5, 7, 6);
  draft.addQuad(0, 1, 5, 4);
  draft.addQuad(2, 6, 7, 3);
  draft.addQuad(0, 4, 6, 2);
  draft.addQuad(1, 3, 7, 5);
  return draft.finish();
}

TriangleMesh uvSphereMesh(double radius, std::uint32_t segments, std::uint32_t rings) {
  Draft draft;
  const std::uint32_t south = draft.add({0.0, 0.0, -radius}), north = draft.add({0.0, 0.0, radius});
  std::uint32_t previous = 0;
  for (std::uint32_t i = 1; i < rings; ++i) {
    const double latitude = pi * i / rings - pi / 2;
    const std::uint32_t ring =
        addRing(draft, radius * std::cos(latitude), radius * std::sin(latitude), segments);
    if (i == 1) addFan(draft, south, ring, segments, true);
    if (i > 1) addBand(draft, previous, ring, segments);
    previous = ring;
  }
  addFan(draft, north, previous, segments, false);
  return draft.finish();
}

TriangleMesh bowlMesh(double inner, double outer, std::uint32_t segments, std::uint32_t rings) {
  Draft draft;
  std::array<std::uint32_t, 2> rims{};
  for (const bool isOuter : {false, true}) {
    const double radius = isOuter ? outer : inner;
    const std::uint32_t south = draft.add({0.0, 0.0, -radius});
    std::uint32_t previous = 0;
    for (std::uint32_t i = 1; i <= rings; ++i) {
      const double latitude = pi * i / (2 * rings) - pi / 2;
      const std::uint32_t ring =
          addRing(draft, radius * std::cos(latitude), radius * std::sin(latitude), segments);
      if (i == 1) addFan(draft, south, ring, segments, isOuter);
      if (i > 1)
        isOuter ? addBand(draft, previous, ring, segments) : addBand(draft, ring, previous, segments);
      previous = ring;
    }
    rims[isOuter ? 1 : 0] = previous;
  }
  addBand(draft, rims[1], rims[0], segments);
  return draft.finish();
}

TriangleMesh icosphereMesh(double radius, std::uint32_t subdivisions) {
  Draft draft = unitIcosphere(subdivisions);
  for (glm::dvec3& p : draft.vertices)
    p *= radius;
  return draft.finish();
}

TriangleMesh torusMesh(double majorRadius, double minorRadius, std::uint32_t majorSegments,
                       std::uint32_t minorSegments) {
  Draft draft;
  for (std::uint32_t i = 0; i < minorSegments; ++i) {
    const double angle = 2.0 * pi * i / minorSegments;
    addRing(draft, majorRadius + minorRadius * std::cos(angle), minorRadius * std::sin(angle), majorSegments);
  }
  for (std::uint32_t i = 0; i < minorSegments; ++i) {
    addBand(draft, i * majorSegments, (i + 1) % minorSegments * majorSegments, majorSegments);
  }
  return draft.finish();
}

TriangleMesh cylinderMesh(double radius, double height, std::uint32_t segments) {
  Draft draft;
  const std::uint32_t lower = addRing(draft, radius, -height / 2, segments);
  const std::uint32_t upper = addRing(draft, radius, height / 2, segments);
  addBand(draft, lower, upper, segments);
  addFan(draft, draft.add({0.0, 0.0, -height / 2}), lower, segments, true);
  addFan(draft, draft.add({0.0, 0.0, height / 2}), upper, segments, false);
  return draft.finish();
}

TriangleMesh tubeMesh(double innerRadius, double outerRadius, double height, std::uint32_t segments) {
  Draft draft;
  const std::uint32_t outerLower = addRing(draft, outerRadius, -height / 2, segments);
  const std::uint32_t outerUpper = addRing(draft, outerRadius, height / 2, segments);
  const std::uint32_t innerLower = addRing(draft, innerRadius, -height / 2, segments);
  const std::uint32_t innerUpper = addRing(draft, innerRadius, height / 2, segments);
  addBand(draft, outerLower, outerUpper, segments);
  addBand(draft, outerUpper, innerUpper, segments);
  addBand(draft, innerUpper, innerLower, segments);
  addBand(draft, innerLower, outerLower, segments);
  return draft.finish();
}

TriangleMesh turnedMesh(std::span<const glm::dvec2> profile, std::uint32_t segments) {
  Draft draft;
  std::vector<std::uint32_t> rings;
  for (const glm::dvec2& ring : profile)
    rings.push_back(addRing(draft, ring.x, ring.y, segments));
  for (std::size_t i = 1; i < rings.size(); ++i)
    addBand(draft, rings[i - 1], rings[i], segments);
  addFan(draft, draft.add({0.0, 0.0, profile.front().y}), rings.front(), segments, true);
  addFan(draft, draft.add({0.0, 0.0, profile.back().y}), rings.back(), segments, false);
  return draft.finish();
}

TriangleMesh coneMesh(double radius, double height, std::uint32_t segments) {
  Draft draft;
  const std::uint32_t ring = addRing(draft, radius, 0.0, segments);
  addFan(draft, draft.add({0.0, 0.0, 0.0}), ring, segments, true);
  addFan(draft, draft.add({0.0, 0.0, height}), ring, segments, false);
  return draft.finish();
}

TriangleMesh starMesh(std::uint64_t seed, double radius, std::uint32_t subdivisions, double roughness) {
  Draft draft = unitIcosphere(subdivisions);
  std::mt19937_64 random(seed);
  for (glm::dvec3& p : draft.vertices)
    p *= radius * (1.0 + roughness * (2.0 * uniform(random) - 1.0));
  return draft.finish();
}

TriangleMesh squareMesh(double size, std::uint32_t divisions) {
  Draft draft;
  for (std::uint32_t j = 0; j <= divisions; ++j) {
    for (std::uint32_t i = 0; i <= divisions; ++i) {
      draft.add({size * i / divisions - size / 2, size * j / divisions - size / 2, 0.0});
    }
  }
  for (std::uint32_t j = 0; j < divisions; ++j) {
    for (std::uint32_t i = 0; i < divisions; ++i) {
      const std::uint32_t corner = j * (divisions + 1) + i;
      draft.addQuad(corner, corner + 1, corner + divisions + 2, corner + divisions + 1);
    }
  }
  return draft.finish();
}

TriangleMesh cutUnevenly(const TriangleMesh& mesh, std::size_t cuts, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<glm::dvec3> x(mesh.vertices().begin(), mesh.vertices().end());
  std::vector<Triangle> t(mesh.triangles().begin(), mesh.triangles().end());
  for (std::size_t i = 0; i < cuts; ++i) {
    const std::size_t f = random() % t.size(), k = random() % 3;
    const std::uint32_t a = t[f][k], b = t[f][(k + 1) % 3];
    const double share = std::uniform_real_distribution(0.05, 0.95)(random);
    const auto middle = static_cast<std::uint32_t>(x.size());
    x.push_back(x[a] + share * (x[b] - x[a]));
    const std::size_t before = t.size();
    for (std::size_t g = 0; g < before; ++g) {
      for (std::size_t j = 0; j < 3; ++j) {
        const std::uint32_t from = t[g][j], to = t[g][(j + 1) % 3], apex = t[g][(j + 2) % 3];
        if (!((from == a && to == b) || (from == b && to == a))) continue;
        t[g] = {from, middle, apex};
        t.push_back({middle, to, apex});
        break;
      }
    }
  }
  return {std::move(x), std::move(t)};
}

TriangleMesh transformed(const TriangleMesh& mesh, double scale, const RigidTransform& motion) {
  std::vector<glm::dvec3> vertices;
  for (const glm::dvec3& p : mesh.vertices())
    vertices.push_back(motion.applyToPoint(scale * p));
  return {std::move(vertices), {mesh.triangles().begin(), mesh.triangles().end()}};
}

TriangleMesh subdivided(const TriangleMesh& mesh, std::uint32_t times) {
  if (times == 0) return mesh;
  Draft draft{{mesh.vertices().begin(), mesh.vertices().end()}, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto next = static_cast<std::uint32_t>(draft.vertices.size());
    const auto [found, isNew] = middles.try_emplace(std::minmax(a, b), next);
    if (isNew) draft.vertices.push_back(0.5 * (mesh.vertices()[a] + mesh.vertices()[b]));
    return found->second;
  };
  for (const Triangle& t : mesh.triangles()) {
    const std::uint32_t ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    draft.addTriangle(t[0], ab, ca);
    draft.addTriangle(ab, t[1], bc);
    draft.addTriangle(ca, bc, t[2]);
    draft.addTriangle(ab, bc, ca);
  }
  return subdivided(draft.finish(), times - 1);
}

TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  Draft draft{{a.vertices().begin(), a.vertices().end()}, {a.triangles().begin(), a.triangles().end()}};
  draft.vertices.insert(draft.vertices.end(), b.vertices().begin(), b.vertices().end());
  const auto shift = static_cast<std::uint32_t>(a.vertices().size());
  for (const Triangle& t : b.triangles())
    draft.addTriangle(t[0] + shift, t[1] + shift, t[2] + shift);
  return draft.finish();
}

TriangleMesh turned(const TriangleMesh& mesh) {
  std::vector<Triangle> triangles;
  for (const Triangle& t : mesh.triangles())
    triangles.push_back({t[0], t[2], t[1]});
  return {{mesh.vertices().begin(), mesh.vertices().end()}, std::move(triangles)};
}

}  // namespace nearfit::test
