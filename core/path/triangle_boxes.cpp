#include "core/path/triangle_boxes.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

#include "core/math/aabb.h"

namespace nearfit {
namespace {

/// Rounding of a placed corner and of a gap, of the lengths involved: a few dozen.
constexpr double kCornerRounding = 1e-14;
/// Triangles in a leaf.
constexpr std::size_t kLeafTriangles = 2;

struct Extent {
  double low, high;
};

/// Extent of a triangle along a direction, from a point.
Extent extentAlong(const glm::dvec3& direction, const TriangleCorners& t, const glm::dvec3& from) noexcept {
  const double x = glm::dot(direction, t[0] - from), y = glm::dot(direction, t[1] - from),
               z = glm::dot(direction, t[2] - from);
  return {std::min({x, y, z}), std::max({x, y, z})};
}

/// Tells if a slab between two triangles is as wide as asked for.
class SlabTest {
 public:
  SlabTest(const TriangleCorners& a, const TriangleCorners& b, double gap) noexcept
      : a_(a), b_(b), squaredGap_(gap * gap) {}

  /// A slab square to a direction of any length. One of no length, or not finite, separates nothing.
  bool separates(const glm::dvec3& direction) const noexcept {
    const Extent a = extentAlong(direction, a_, a_[0]), b = extentAlong(direction, b_, a_[0]);
    const double width = std::max(b.low - a.high, a.low - b.high);
    return width > 0.0 && width * width >= squaredGap_ * glm::dot(direction, direction);
  }

 private:
  const TriangleCorners &a_, &b_;
  double squaredGap_;
};

glm::dvec3 sideOf(const TriangleCorners& t, std::size_t i) noexcept {
  return t[(i + 1) % 3] - t[i];
}

/// From a side, square to it, to a point.
glm::dvec3 awayFromSide(const TriangleCorners& t, std::size_t i, const glm::dvec3& point) noexcept {
  const glm::dvec3 side = sideOf(t, i), way = point - t[i];
  const double squared = glm::dot(side, side);
  return squared > 0.0 ? way - side * (glm::dot(side, way) / squared) : way;
}

double squaredBeyond(const glm::dvec3& between, const glm::dvec3& reach) noexcept {
  const glm::dvec3 beyond = glm::max(glm::abs(between) - reach, glm::dvec3(0.0));
  return glm::dot(beyond, beyond);
}

/// Turns half extents of a box into those that the other frame sees.
glm::dmat3 absoluteOf(const glm::dmat3& m) noexcept {
  return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])};
}

}  // namespace

bool areSlabApart(const TriangleCorners& a, const TriangleCorners& b, double gap) noexcept {
  const SlabTest test(a, b, gap);
  // Faces and the way between the middles first: most pairs need no more.
  if (test.separates(glm::cross(sideOf(a, 0), sideOf(a, 1)))) return true;
  if (test.separates(glm::cross(sideOf(b, 0), sideOf(b, 1)))) return true;
  if (test.separates(a[0] + a[1] + a[2] - b[0] - b[1] - b[2])) return true;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (test.separates(glm::cross(sideOf(a, i), sideOf(b, j)))) return true;
      if (test.separates(awayFromSide(a, i, b[j]))) return true;
      if (test.separates(awayFromSide(b, j, a[i]))) return true;
      if (test.separates(a[i] - b[j])) return true;
    }
  }
  return false;
}

TriangleBoxes::TriangleBoxes(const TriangleMesh& mesh) {
  Aabb box;
  for (const Triangle& t : mesh.triangles()) {
    for (const std::uint32_t v : t)
      box.add(mesh.vertices()[v]);
  }
  if (box.isEmpty()) return;
  centre_ = box.centre();
  reach_ = box.largestCoordinate();
  std::vector<Item> items;
  items.reserve(mesh.triangles().size());
  corners_.reserve(mesh.triangles().size());
  for (std::size_t i = 0; i < mesh.triangles().size(); ++i) {
    const Triangle& t = mesh.triangles()[i];
    corners_.push_back(
        {mesh.vertices()[t[0]] - centre_, mesh.vertices()[t[1]] - centre_, mesh.vertices()[t[2]] - centre_});
    const TriangleCorners& c = corners_.back();
    items.push_back({c[0] + c[1] + c[2], static_cast<std::uint32_t>(i)});
  }
  nodes_.reserve(2 * items.size() / kLeafTriangles + 2);
  nodes_.emplace_back();
  build(0, items, 0);
  // Triangles of a leaf lie beside each other.
  std::vector<TriangleCorners> ordered;
  ordered.reserve(corners_.size());
  for (const Item& item : items)
    ordered.push_back(corners_[item.triangle]);
  corners_ = std::move(ordered);
}

/// Recurses to the logarithm of the number of triangles: halves are equal.
void TriangleBoxes::build(std::uint32_t node, std::span<Item> items, std::uint32_t first) {
  Aabb box, middles;
  for (const Item& item : items) {
    for (const glm::dvec3& corner : corners_[item.triangle])
      box.add(corner);
    middles.add(item.middle);
  }
  // Rounded outward, so that each corner is inside.
  nodes_[node].centre = box.centre();
  nodes_[node].half = 0.5 * (box.upper - box.lower) + glm::dvec3(kCornerRounding * box.largestCoordinate());
  if (items.size() <= kLeafTriangles) {
    nodes_[node].first = first;
    nodes_[node].count = static_cast<std::uint32_t>(items.size());
    return;
  }
  const glm::dvec3 d = middles.upper - middles.lower;
  const glm::length_t axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
  const std::size_t half = items.size() / 2;
  std::ranges::nth_element(items, items.begin() + static_cast<std::ptrdiff_t>(half), {},
                           [axis](const Item& item) { return item.middle[axis]; });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].child = child;
  nodes_.emplace_back();
  nodes_.emplace_back();
  build(child, items.first(half), first);
  build(child + 1, items.subspan(half), first + static_cast<std::uint32_t>(half));
}

bool TriangleBoxes::isApart(const TriangleBoxes& part, const RigidTransform& thisFromPart, double gap,
                            Waiting& waiting) const {
  if (nodes_.empty() || part.nodes_.empty()) return true;
  const glm::dmat3 turn = glm::mat3_cast(thisFromPart.rotation), back = glm::transpose(turn);
  const glm::dmat3 absolute = absoluteOf(turn), absoluteBack = absoluteOf(back);
  const glm::dvec3 shift = turn * part.centre_ + thisFromPart.translation - centre_;
  const double rounding =
      kCornerRounding * (2.0 * reach_ + 2.0 * part.reach_ + glm::length(thisFromPart.translation));
  const double needed = gap + rounding, squaredNeeded = needed * needed;
  // Not finite where the pose is not: then nothing is proven.
  if (!std::isfinite(needed) || !(gap > 0.0)) return false;
  waiting.clear();
  waiting.emplace_back(0, 0);
  while (!waiting.empty()) {
    const auto [mine, its] = waiting.back();
    waiting.pop_back();
    const Node &a = nodes_[mine], &b = part.nodes_[its];
    const glm::dvec3 between = turn * b.centre + shift - a.centre;
    if (squaredBeyond(between, a.half + absolute * b.half) >= squaredNeeded) continue;
    if (squaredBeyond(back * between, b.half + absoluteBack * a.half) >= squaredNeeded) continue;
    if (a.child == 0 && b.child == 0) {
      for (std::uint32_t k = b.first; k < b.first + b.count; ++k) {
        const TriangleCorners& own = part.corners_[k];
        const TriangleCorners placed{turn * own[0] + shift, turn * own[1] + shift, turn * own[2] + shift};
        for (std::uint32_t i = a.first; i < a.first + a.count; ++i) {
          if (!areSlabApart(corners_[i], placed, needed)) return false;
        }
      }
      continue;
    }
    const bool isMineOpened = b.child == 0 || (a.child != 0 && a.size() >= b.size());
    const std::uint32_t next = isMineOpened ? a.child : b.child;
    for (std::uint32_t i = next; i < next + 2; ++i)
      isMineOpened ? waiting.emplace_back(i, its) : waiting.emplace_back(mine, i);
  }
  return true;
}

}  // namespace nearfit
