#pragma once

#include <array>
#include <functional>
#include <map>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace nearfit::test {

/// A solid of the cells of a grid of 2 x 2 x 2 cells, each 1 m wide, from -1 to 1, that `isSolid` takes (0 or 1 along
/// x, y, z). Closed, with outward faces; its corners are shared.
inline TriangleMesh cellSolid(const std::function<bool(int, int, int)>& isSolid) {
  std::vector<glm::dvec3> vertices;
  std::vector<Triangle> triangles;
  std::map<std::array<int, 3>, std::uint32_t> indexOf;
  const auto vertexAt = [&](const std::array<int, 3>& p) {
    const auto [at, isNew] = indexOf.emplace(p, static_cast<std::uint32_t>(vertices.size()));
    if (isNew) vertices.emplace_back(p[0] - 1.0, p[1] - 1.0, p[2] - 1.0);
    return at->second;
  };
  const auto isIn = [&](const std::array<int, 3>& c) {
    for (const int i : c)
      if (i < 0 || i > 1) return false;
    return isSolid(c[0], c[1], c[2]);
  };
  for (int cell = 0; cell < 8; ++cell) {
    const std::array<int, 3> c{cell & 1, cell >> 1 & 1, cell >> 2 & 1};
    if (!isIn(c)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> beside = c;
        beside[axis] += 2 * side - 1;
        if (isIn(beside)) continue;
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::array<std::uint32_t, 4> corners{};
        for (std::size_t i = 0; i < 4; ++i) {
          std::array<int, 3> p = c;
          p[axis] += side;
          p[u] += i == 1 || i == 2;
          p[v] += i >= 2;
          corners[i] = vertexAt(p);
        }
        // Anticlockwise about the axis; the lower side faces the other way.
        const auto [q0, q1, q2, q3] = corners;
        if (side == 1) {
          triangles.push_back({q0, q1, q2});
          triangles.push_back({q0, q2, q3});
        } else {
          triangles.push_back({q0, q2, q1});
          triangles.push_back({q0, q3, q2});
        }
      }
    }
  }
  return {std::move(vertices), std::move(triangles)};
}

/// A cube without one of its eight cells: three walls about the corner at the origin, open towards +x, +y, +z.
inline TriangleMesh cornerSolid() {
  return cellSolid([](int x, int y, int z) { return x + y + z < 3; });
}

/// A floor below z = 0 and a wall below x = 0.
inline TriangleMesh floorAndWall() {
  return cellSolid([](int x, int, int z) { return x == 0 || z == 0; });
}

}  // namespace nearfit::test
