#include "tests/bench/swept_mesh.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace nearfit::bench {

TriangleMesh sweptMesh(std::span<const SweptRing> rings, std::uint32_t around) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  vertices.reserve(rings.size() * around + 2);
  triangles.reserve(2 * rings.size() * around);
  for (const SweptRing& ring : rings) {
    for (std::uint32_t i = 0; i < around; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / around;
      vertices.push_back(ring.centre + std::cos(angle) * ring.u + std::sin(angle) * ring.v);
    }
  }
  const auto start = static_cast<std::uint32_t>(vertices.size()), end = start + 1;
  const auto last = static_cast<std::uint32_t>(rings.size() - 1) * around;
  vertices.push_back(rings.front().centre);
  vertices.push_back(rings.back().centre);
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around;
    triangles.push_back({start, j, i});
    for (std::uint32_t lower = 0; lower < last; lower += around) {
      const std::uint32_t upper = lower + around;
      triangles.push_back({lower + i, lower + j, upper + j});
      triangles.push_back({lower + i, upper + j, upper + i});
    }
    triangles.push_back({end, last + i, last + j});
  }
  return {std::move(vertices), std::move(triangles)};
}

}  // namespace nearfit::bench
