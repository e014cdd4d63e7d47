#include "core/proximity/overlap/containment.h"

#include <array>
#include <bit>
#include <cmath>
#include <random>

#include <glm/geometric.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/overlap/interference.h"
#include "core/proximity/query/segment_kernel.h"

namespace nearfit {
namespace {

/// Rounding of a segment to single precision, as a fraction of the lengths involved: some ten roundings.
constexpr double kRayPadding = 1e-6;

/// Max number of rays before a point counts as inside, the safe answer. A ray is unclear only if it hits an
/// edge to the last bit.
constexpr int kMaxRays = 64;

/// True if as many triangles run along an edge one way as the other.
bool isBalanced(const TriangleMesh& mesh, std::uint32_t edge) {
  const MeshEdge& e = mesh.edges()[edge];
  int balance = 0;
  for (const std::uint32_t f : mesh.facesOfEdge(edge)) {
    const Triangle& t = mesh.triangles()[f];
    for (std::size_t k = 0; k < 3; ++k) {
      if (t[k] == e.v0 && t[(k + 1) % 3] == e.v1) ++balance;
      if (t[k] == e.v1 && t[(k + 1) % 3] == e.v0) --balance;
    }
  }
  return balance == 0;
}

SegmentBound boundOf(const NormalConeTree& tree, const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 middle = 0.5 * (from + to), half = 0.5 * (to - from);
  SegmentBound bound;
  for (glm::length_t i = 0; i < 3; ++i) {
    bound.middle[static_cast<std::size_t>(i)] = static_cast<float>(middle[i]);
    bound.half[static_cast<std::size_t>(i)] = static_cast<float>(half[i]);
  }
  bound.padding = static_cast<float>(kRayPadding * (tree.size() + glm::length(middle) + glm::length(half)));
  return bound;
}

/// Calls visit(triangle) for every face of the hierarchy that the segment may meet.
template <class Visit>
void visitFaces(const NormalConeTree& tree, const SegmentBound& bound, Visit&& visit) {
  const SegmentKernel kernel = segmentKernel(defaultSimdLevel());
  const std::uint32_t top = tree.nodes()[0].child[0];
  std::vector<std::uint32_t> stack{NormalConeTree::isLeaf(top) ? 0 : NormalConeTree::nodeIndex(top)};
  while (!stack.empty()) {
    const NormalConeTree::Node& node = tree.nodes()[stack.back()];
    stack.pop_back();
    for (std::uint32_t lanes = kernel(node, bound); lanes != 0; lanes &= lanes - 1) {
      const std::uint32_t child = node.child[static_cast<std::size_t>(std::countr_zero(lanes))];
      if (!NormalConeTree::isLeaf(child)) {
        stack.push_back(NormalConeTree::nodeIndex(child));
      } else if (NormalConeTree::leafKind(child) == FeatureKind::Face) {
        visit(tree.faces()[NormalConeTree::leafIndex(child)].face);
      }
    }
  }
}

}  // namespace

MeshComponents piecesOf(const TriangleMesh& mesh) {
  constexpr std::uint32_t kNone = Interference::kNone;
  MeshComponents pieces;
  pieces.pieceOf.assign(mesh.triangles().size(), kNone);
  std::vector<std::uint32_t> waiting;
  const auto add = [&](std::uint32_t triangle) {
    if (pieces.pieceOf[triangle] != kNone) return;
    pieces.pieceOf[triangle] = static_cast<std::uint32_t>(pieces.firstTriangle.size() - 1);
    waiting.push_back(triangle);
  };
  for (std::uint32_t first = 0; first < mesh.triangles().size(); ++first) {
    if (pieces.pieceOf[first] != kNone) continue;
    pieces.firstTriangle.push_back(first);
    add(first);
    while (!waiting.empty()) {
      const std::uint32_t f = waiting.back();
      waiting.pop_back();
      for (const std::uint32_t e : mesh.edgesOfTriangle(f)) {
        // An edge may have very many faces: only the first visits the others.
        const auto faces = mesh.facesOfEdge(e);
        add(faces[0]);
        if (faces[0] != f) continue;
        for (const std::uint32_t next : faces)
          add(next);
      }
    }
  }
  pieces.isClosed.assign(pieces.firstTriangle.size(), true);
  for (std::uint32_t e = 0; e < mesh.edges().size(); ++e) {
    if (!isBalanced(mesh, e)) pieces.isClosed[pieces.pieceOf[mesh.facesOfEdge(e)[0]]] = false;
  }
  for (std::uint32_t f = 0; f < mesh.triangles().size(); ++f) {
    if (!pieces.isClosed[pieces.pieceOf[f]]) continue;
    for (const std::uint32_t v : mesh.triangles()[f])
      pieces.closedBox.add(mesh.vertices()[v]);
  }
  return pieces;
}

PlacedSolid::PlacedSolid(const PlacedMesh& mesh, const MeshComponents& pieces)
    : mesh_(mesh), pieces_(pieces), box_(mesh.placed(pieces.closedBox)) {}

bool PlacedSolid::contains(const glm::dvec3& point) const {
  if (!doOverlap(box_, {point, point})) return false;
  // The same rays each time, none along an axis, where CAD models have their edges.
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  const double reach = 2.0 * box_.diagonal();
  for (int i = 0; i < kMaxRays; ++i) {
    const glm::dvec3 direction(coordinate(random), coordinate(random), coordinate(random));
    const double length = glm::length(direction);
    if (!(length > 0.1)) continue;
    const Count count = countAlong(point, point + reach / length * direction);
    if (count.isClear) return count.windings != 0;
  }
  return true;
}

PlacedSolid::Count PlacedSolid::countAlong(const glm::dvec3& from, const glm::dvec3& to) const {
  Count count;
  const auto add = [&](std::uint32_t triangle) { countTriangle(triangle, from, to, count); };
  if (!mesh_.tree().isEmpty())
    visitFaces(mesh_.tree(), boundOf(mesh_.tree(), mesh_.toTree(from), mesh_.toTree(to)), add);
  for (const std::uint32_t triangle : mesh_.looseTriangles())
    add(triangle);
  return count;
}

void PlacedSolid::countTriangle(std::uint32_t triangle, const glm::dvec3& from, const glm::dvec3& to,
                                Count& count) const {
  if (!count.isClear || !pieces_.isClosed[pieces_.pieceOf[triangle]]) return;
  switch (crossingOf(from, to, mesh_.corners(triangle))) {
    case Crossing::None:
      return;
    case Crossing::Out:
      ++count.windings;
      return;
    case Crossing::In:
      --count.windings;
      return;
    case Crossing::Unclear:
      count.isClear = false;
      return;
  }
}

}  // namespace nearfit
