#include "core/proximity/query/leaf_margins.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"

namespace nearfit {
namespace {

/// Cheap upper bound on the length, at most 1.74 times it; error bounds may be that much too wide.
double mostLength(const glm::dvec3& v) noexcept {
  return std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
}

}  // namespace

LeafMargins::LeafMargins(const NormalConeTree& scene, const NormalConeTree& part,
                         const RigidTransform& sceneFromPart) noexcept {
  constexpr double kExtendedUnit = 0.5 * static_cast<double>(std::numeric_limits<long double>::epsilon());
  constexpr double kRoundings = 24.0, kOfSum = 16.0;
  const double size = scene.size() + part.size(), way = glm::length(sceneFromPart.translation);
  // Upper bound on every number that the centred pose was made from: in double precision up to where
  // coordinates count as near the origin, in extended precision beyond.
  const double origin = way + 2.0 * (glm::length(scene.centre()) + glm::length(part.centre()));
  pointError_ = kRoundings * kUnit * (size + way) + kOfSum * kUnit * std::min(origin, kNearOrigin * size) +
                kOfSum * kExtendedUnit * origin;
}

bool LeafMargins::isClearOfVertex(const NormalConeTree& tree, std::uint32_t vertex, const glm::dvec3& d,
                                  double turn) noexcept {
  const NormalConeTree::VertexLeaf& leaf = tree.vertices()[vertex];
  const glm::dvec3& v = tree.positions()[leaf.vertex];
  const double error = localError(tree);
  for (const std::uint32_t n : tree.neighbours(leaf)) {
    const glm::dvec3 e = tree.positions()[n] - v;
    if (!(glm::dot(d, e) < -(error + turn * mostLength(e)))) return false;
  }
  return true;
}

bool LeafMargins::isClearOfEdge(const NormalConeTree& tree, std::uint32_t edge, const glm::dvec3& start,
                                const glm::dvec3& along, double length, const glm::dvec3& d,
                                double turn) noexcept {
  const double error = localError(tree);
  for (const std::uint32_t corner : tree.edges()[edge].opposite) {
    const glm::dvec3 w = tree.positions()[corner] - start;
    const double far = glm::dot(w, along);
    const glm::dvec3 inward = w - far * along;
    // The error of a short edge's direction grows with the distance along it. All is times the length.
    const double bound = error * (length + 2.0 * std::abs(far)) + turn * mostLength(inward) * length;
    if (!(glm::dot(d, inward) * length < -bound)) return false;
  }
  return true;
}

bool LeafMargins::isClearInFace(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& normal,
                                const glm::dvec3& foot, double error) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 inward = glm::cross(normal, corners[(k + 1) % 3] - corners[k]);
    if (!(glm::dot(inward, foot - corners[k]) > error * mostLength(inward))) return false;
  }
  return true;
}

}  // namespace nearfit
