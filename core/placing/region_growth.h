#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// The triangles connected with one through edges of two faces, as far as `accepts(triangle)` goes. The first
/// is always among them.
/// @param most  No more than so many.
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
