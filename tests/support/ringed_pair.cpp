#include "tests/support/ringed_pair.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "tests/support/mesh_generators.h"

namespace nearfit::test {
namespace {

constexpr std::uint32_t kSegments = 16;

/// Vertices of the wall moved to the wave about `radius` at their height; the middles of a wall's sides lie
/// within the circle of its corners. What lies farther out stays, what lies within goes along.
TriangleMesh ringed(const TriangleMesh& mesh, double wall, double radius, double wave) {
  constexpr double kRounding = 1.001, kWithin = 0.97;
  std::vector<glm::dvec3> vertices(mesh.vertices().begin(), mesh.vertices().end());
  for (glm::dvec3& x : vertices) {
    const double before = std::hypot(x.x, x.y);
    if (before > kRounding * wall) continue;
    const double scale =
        (radius + wave * std::sin(2.0 * std::numbers::pi * x.z)) / (before < kWithin * wall ? wall : before);
    x = {scale * x.x, scale * x.y, x.z};
  }
  return {std::move(vertices), {mesh.triangles().begin(), mesh.triangles().end()}};
}

}  // namespace

TriangleMesh RingedPair::tube() const {
  return ringed(subdivided(tubeMesh(radius, 2.0 * radius, 1.0, kSegments), detail), radius, radius, wave);
}

TriangleMesh RingedPair::rod() const {
  return ringed(subdivided(cylinderMesh(radius, 1.2, kSegments), detail), radius, radius - gap, wave);
}

}  // namespace nearfit::test
