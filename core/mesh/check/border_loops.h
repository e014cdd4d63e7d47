#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace nearfit {

/// A way along open edges, in the direction in which their triangles run.
struct BorderLoop {
  std::vector<std::uint32_t> vertices;  ///< In order, each once.
  /// False for a way that ends, as where neighbours are oriented inconsistently.
  bool isClosed = true;
  double length = 0.0;  ///< [m]

  std::size_t edgeCount() const noexcept { return vertices.size() - (isClosed ? 0U : 1U); }
};

/// Finds the loops of a mesh's open edges, each edge in one. Where several loops touch in a vertex, each stays on the
/// same sheet of the surface, and passes the vertex once. In the order of their first edges. About O(n).
std::vector<BorderLoop> borderLoopsOf(const TriangleMesh& mesh);

}  // namespace nearfit
