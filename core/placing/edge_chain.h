#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/placing/circle_fit.h"

namespace nearfit {

/// Edges of the shape (isSharp) one behind the other, that lie on one circle or in one line.
struct EdgeChain {
  /// In order; the first again as the last where it is closed.
  std::vector<std::uint32_t> vertices;
  bool isRound = false;
  Circle circle;  ///< Of a round one; else its centre is the middle of the line, its axis along it, radius 0.
};

/// The chain that an edge of the shape is of: the whole circle or arc where there are at least five corners
/// on one, else the straight edge. O(n) of the chain.
EdgeChain edgeChain(const TriangleMesh& mesh, std::uint32_t sharpEdge);

}  // namespace nearfit
