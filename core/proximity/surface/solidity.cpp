#include "core/proximity/surface/solidity.h"

#include <algorithm>
#include <limits>

#include <glm/geometric.hpp>

#include "core/proximity/surface/outer_windings.h"

namespace nearfit {
namespace {

/// Roundings in the volume of a triangle's tetrahedron, each relative to the product of lengths.
constexpr double kRoundings = 32.0;

/// Six times the volume of a component.
struct Volume {
  double sum = 0.0;
  double size = 0.0;  ///< Sum of the terms if their vectors were orthogonal.
  double count = 0.0;

  bool isPositive() const {
    return sum > (count + kRoundings) * std::numeric_limits<double>::epsilon() * size;
  }
};

bool haveAllPositiveVolume(const TriangleMesh& mesh, const MeshComponents& pieces) {
  std::vector<Volume> volumes(pieces.firstTriangle.size());
  for (std::uint32_t i = 0; i < pieces.pieceOf.size(); ++i) {
    const std::uint32_t piece = pieces.pieceOf[i];
    // Relative to a corner of the component, so that a small one far away is not lost in rounding.
    const glm::dvec3 origin = mesh.vertices()[mesh.triangles()[pieces.firstTriangle[piece]][0]];
    const TriangleCorners t = cornersOf(mesh, i);
    const glm::dvec3 a = t[0] - origin, b = t[1] - t[0], c = t[2] - t[0];
    volumes[piece].sum += glm::dot(a, glm::cross(b, c));
    volumes[piece].size += glm::length(a) * glm::length(b) * glm::length(c);
    volumes[piece].count += 1.0;
  }
  return std::ranges::all_of(volumes, &Volume::isPositive);
}

}  // namespace

bool isSolidThroughout(const TriangleMesh& mesh) {
  if (!mesh.topology().isClosed() || !mesh.topology().isOriented()) return false;
  const MeshComponents pieces = piecesOf(mesh);
  if (!haveAllPositiveVolume(mesh, pieces)) return false;
  const PieceBoxes boxes(mesh, pieces);
  const auto crossings = findSelfCrossings(mesh, pieces, boxes);
  if (!crossings) return false;
  return crossings->empty() || areOuterWindingsPositive(mesh, pieces, boxes, *crossings);
}

}  // namespace nearfit
