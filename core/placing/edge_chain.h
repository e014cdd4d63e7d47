#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/placing/circle_fit.h"

namespace nearfit {

/// Consecutive sharp edges (isSharp) on one circle or line.
struct EdgeChain {
  /// In order; if closed, the first is repeated at the end.
  std::vector<std::uint32_t> vertices;
  bool isRound = false;
  /// Of a round chain. For a line: centre at its middle, axis along it, radius 0.
  Circle circle;
};

/// The chain that contains a sharp edge: the whole circle or arc if it has at least five corners, else the
/// straight edge. O(n) in the chain.
EdgeChain edgeChain(const TriangleMesh& mesh, std::uint32_t sharpEdge);

}  // namespace nearfit
