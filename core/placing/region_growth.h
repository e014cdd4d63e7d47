#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// Triangles connected to `first` through edges with two faces, as long as `accepts(triangle)`. `first` is
/// always included. O(n) in the region.
/// @param most  Max number of triangles.
template <class Accept>
std::vector<std::uint32_t> grownRegion(const TriangleMesh& mesh, std::uint32_t first, Accept&& accepts,
                                       std::size_t most = TriangleMesh::kMaxTriangles) {
  std::vector<std::uint32_t> region{first};
  std::unordered_set<std::uint32_t> seen{first};
  for (std::size_t next = 0; next < region.size() && region.size() < most; ++next) {
    for (const std::uint32_t edge : mesh.edgesOfTriangle(region[next])) {
      const auto faces = mesh.facesOfEdge(edge);
      if (faces.size() != 2) continue;
      const std::uint32_t other = faces[0] == region[next] ? faces[1] : faces[0];
      if (seen.insert(other).second && accepts(other)) region.push_back(other);
    }
  }
  return region;
}

}  // namespace nearfit
