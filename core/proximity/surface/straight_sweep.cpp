#include "core/proximity/surface/straight_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/proximity/hierarchy/normal_cone_tree.h"

namespace nearfit {
namespace {

/// Max error of a node's single-precision box, as a fraction of its size: its axes are unit and
/// perpendicular to 1e-7.
constexpr double kNodeBoxSlack = 1e-6;
/// Edges nearer to parallel than this have no reliable common normal [rad].
constexpr double kParallelSides = 1e-12;

struct Shadow {
  double lower, upper;
};
Shadow shadowOf(const TriangleCorners& corners, const glm::dvec3& axis) noexcept {
  const double a = glm::dot(corners[0], axis), b = glm::dot(corners[1], axis), c = glm::dot(corners[2], axis);
  return {std::min({a, b, c}), std::max({a, b, c})};
}

struct SweptSides {
  std::array<glm::dvec3, 3> side;
  glm::dvec3 normal;  ///< Not unit.
};
SweptSides sidesOf(const TriangleCorners& t) noexcept {
  return {{t[1] - t[0], t[2] - t[1], t[0] - t[2]}, glm::cross(t[1] - t[0], t[2] - t[0])};
}

class AxisSearch {
 public:
  AxisSearch(const TriangleCorners& fixed, const TriangleCorners& moving, const glm::dvec3& direction,
             double within) noexcept
      : fixed_(fixed), moving_(moving), direction_(direction), within_(within) {}

  /// @param longest  Length that the axis would have if its factors were perpendicular.
  /// @return False once the triangles can never touch within the travel of interest.
  bool look(const glm::dvec3& axis, double longest) noexcept {
    const double length = glm::length(axis);
    if (!(length > kParallelSides * longest)) return true;
    const glm::dvec3 unit = axis / length;
    const Shadow a = shadowOf(fixed_, unit), b = shadowOf(moving_, unit);
    const double speed = glm::dot(direction_, unit);
    const SweepStretch::Cut cut = sweep_.stretch.cut(b.lower - a.upper, b.upper - a.lower, speed);
    if (cut.isFirst) sweep_.firstNormal = speed < 0.0 ? unit : -unit;
    if (cut.isLast) sweep_.lastNormal = speed > 0.0 ? unit : -unit;
    return !sweep_.stretch.isEmpty() && sweep_.stretch.from <= within_;
  }

  TriangleSweep found() const noexcept { return sweep_; }

 private:
  const TriangleCorners &fixed_, &moving_;
  glm::dvec3 direction_;
  double within_;
  TriangleSweep sweep_;
};

bool lookAll(AxisSearch& search, const SweptSides& a, const SweptSides& b) noexcept {
  for (const SweptSides* t : {&a, &b}) {
    const double longest =
        std::max({glm::length(t->side[0]), glm::length(t->side[1]), glm::length(t->side[2])});
    if (!search.look(t->normal, longest * longest)) return false;
    for (const glm::dvec3& side : t->side) {
      if (!search.look(glm::cross(t->normal, side), glm::length(t->normal) * glm::length(side))) return false;
    }
  }
  for (const glm::dvec3& e : a.side) {
    for (const glm::dvec3& f : b.side) {
      if (!search.look(glm::cross(e, f), glm::length(e) * glm::length(f))) return false;
    }
  }
  return true;
}

bool hasFaces(std::uint32_t child) noexcept {
  if (child == NormalConeTree::kNoChild) return false;
  return !NormalConeTree::isLeaf(child) || NormalConeTree::leafKind(child) == FeatureKind::Face;
}

std::vector<SweptEntry> childrenOf(const NormalConeTree& tree, std::uint32_t node) {
  std::vector<SweptEntry> children;
  const NormalConeTree::Node& n = tree.nodes()[node];
  for (std::size_t lane = 0; lane < NormalConeTree::kWidth; ++lane) {
    if (!hasFaces(n.child[lane])) continue;
    const NormalConeTree::Bound b = n.bound(lane);
    children.push_back({n.child[lane],
                        {{b.centre[0], b.centre[1], b.centre[2]},
                         {{b.n[0], b.n[1], b.n[2]}, {b.u[0], b.u[1], b.u[2]}, {b.v[0], b.v[1], b.v[2]}},
                         {b.half[0], b.half[1], b.half[2]}}});
  }
  return children;
}

}  // namespace

TriangleSweep sweepTriangles(const TriangleCorners& fixed, const TriangleCorners& moving,
                             const glm::dvec3& direction, double within) noexcept {
  AxisSearch search(fixed, moving, direction, within);
  if (lookAll(search, sidesOf(fixed), sidesOf(moving))) return search.found();
  TriangleSweep none;
  none.stretch.to = -1.0;
  return none;
}

StraightSweep::StraightSweep(const NormalConeTree& scene, const NormalConeTree& part,
                             const RigidTransform& sceneFromPart)
    : scene_(scene),
      part_(part),
      placed_(scene, part, sceneFromPart),
      turn_(glm::mat3_cast(placed_.pose().rotation)),
      slack_(placed_.rounding()),
      keptOfScene_(scene.nodes().size()),
      keptOfPart_(part.nodes().size()) {}

std::span<const SweptEntry> StraightSweep::sceneChildren(std::uint32_t node) {
  std::vector<SweptEntry>& children = keptOfScene_[node];
  if (children.empty()) children = childrenOf(scene_, node);
  return children;
}

std::span<const SweptEntry> StraightSweep::partChildren(std::uint32_t node) {
  std::vector<SweptEntry>& children = keptOfPart_[node];
  if (children.empty()) {
    children = childrenOf(part_, node);
    for (SweptEntry& entry : children) {
      entry.box.centre = turn_ * entry.box.centre + placed_.pose().translation;
      entry.box.axes = turn_ * entry.box.axes;
    }
  }
  return children;
}

std::optional<SweepStretch> StraightSweep::meeting(const SweptBox& scene, const SweptBox& part,
                                                   const glm::dvec3& direction,
                                                   double within) const noexcept {
  const double slack = slack_ + kNodeBoxSlack * (scene.size() + part.size());
  const glm::dvec3 between = part.centre - scene.centre;
  // [k][j]: cosine between axis k of the scene's box and axis j of the part's. A box reaches half its side along its own axis,
  // to within the slack.
  const glm::dmat3 cosines = glm::transpose(glm::transpose(scene.axes) * part.axes);
  glm::dmat3 sizes;
  for (int k = 0; k < 3; ++k)
    sizes[k] = glm::abs(cosines[k]);
  const glm::dvec3 sceneReach = scene.half + part.half * sizes, partReach = part.half + sizes * scene.half;
  SweepStretch stretch;
  const auto isOut = [&](const glm::dvec3& axis, double reach) {
    const double apart = glm::dot(between, axis);
    stretch.cut(apart - reach - slack, apart + reach + slack, glm::dot(direction, axis));
    return stretch.isEmpty() || stretch.from > within;
  };
  for (int k = 0; k < 3; ++k) {
    if (isOut(scene.axes[k], sceneReach[k])) return std::nullopt;
  }
  for (int j = 0; j < 3; ++j) {
    if (isOut(part.axes[j], partReach[j])) return std::nullopt;
  }
  return stretch;
}

}  // namespace nearfit
