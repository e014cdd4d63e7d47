#include "core/proximity/surface/point_distance.h"

#include <array>
#include <cmath>
#include <cstddef>

#include <glm/geometric.hpp>

#include "core/math/nearest_on_segment.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/triangle_distance.h"

namespace nearfit {
namespace {

constexpr std::size_t kLanes = NormalConeTree::kWidth;

/// Rounding of the distance to a box in single precision, as a fraction of the lengths involved: some ten roundings.
constexpr float kBoxPadding = 1e-6F;
/// Rounding of a squared lower bound, relative.
constexpr float kSquareSlack = 1.0F - 1e-6F;

/// A child that waits to be opened, or a face to be measured.
struct Waiting {
  std::uint32_t child;
  float squared;  ///< Lower bound on its squared distance [m^2].
};

/// Each node opened leaves at most all its children but one waiting, and the way down is no longer than kMaxDepth.
constexpr std::size_t kMaxWaiting = kLanes * (NormalConeTree::kMaxDepth + 1);

/// Squared lower bounds on the distances to the boxes of a node [m^2].
/// @param point  In the hierarchy's centred frame [m].
std::array<float, kLanes> boundsTo(const NormalConeTree::Node& node, const std::array<float, 3>& point,
                                   float padding) noexcept {
  std::array<float, kLanes> squared;
  const auto beyond = [padding](float along, float half) {
    const float gap = std::abs(along) - half - padding;
    return gap > 0.0F ? gap * gap : 0.0F;
  };
  for (std::size_t i = 0; i < kLanes; ++i) {
    const float dx = point[0] - node.centre[0][i], dy = point[1] - node.centre[1][i],
                dz = point[2] - node.centre[2][i];
    const float nx = node.n[0][i], ny = node.n[1][i], nz = node.n[2][i];
    const float ux = node.u[0][i], uy = node.u[1][i], uz = node.u[2][i];
    const float vx = ny * uz - nz * uy, vy = nz * ux - nx * uz, vz = nx * uy - ny * ux;
    squared[i] = kSquareSlack * (beyond(dx * nx + dy * ny + dz * nz, node.half[0][i]) +
                                 beyond(dx * ux + dy * uy + dz * uz, node.half[1][i]) +
                                 beyond(dx * vx + dy * vy + dz * vz, node.half[2][i]));
  }
  return squared;
}

bool isNoFace(std::uint32_t child) noexcept {
  return NormalConeTree::isLeaf(child) && NormalConeTree::leafKind(child) != FeatureKind::Face;
}

NearestPoint nearestOnSides(const TriangleCorners& corners, const glm::dvec3& point) noexcept {
  NearestPoint best;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 at = nearestOnSegment(corners[k], corners[(k + 1) % 3], point);
    const double distance = glm::distance(at, point);
    if (distance < best.distance) best = {distance, at, 0};
  }
  return best;
}

/// Takes the nearest point of a triangle if it is nearer than `best`. Coordinates over one without an area are NaN, or
/// those of a triangle as thin as rounding: nothing, or a point of its sides.
void improve(const TriangleCorners& corners, std::uint32_t triangle, const glm::dvec3& point,
             NearestPoint& best) noexcept {
  const TriangleFrame frame(corners);
  const TriangleFrame::Coordinates at = frame.of(point);
  if (!(std::abs(at.z) < best.distance)) return;
  NearestPoint found{std::abs(at.z), point - at.z * frame.normal(), 0};
  if (!frame.holds(at.x, at.y)) found = nearestOnSides(corners, point);
  if (!(found.distance < best.distance)) return;
  best = found;
  best.triangle = triangle;
}

/// The search of one point.
class PointSearch {
 public:
  /// @param point  In the hierarchy's centred frame [m].
  PointSearch(const NormalConeTree& tree, const glm::dvec3& point, NearestPoint& best) noexcept
      : tree_(tree),
        point_(point),
        single_{static_cast<float>(point.x), static_cast<float>(point.y), static_cast<float>(point.z)},
        padding_(kBoxPadding * static_cast<float>(tree.size() + glm::length(point))),
        best_(best) {}

  void run() noexcept {
    const std::uint32_t top = tree_.nodes()[0].child[0];
    if (NormalConeTree::isLeaf(top)) {
      open(0);
    } else {
      open(NormalConeTree::nodeIndex(top));
    }
    while (count_ > 0) {
      const Waiting next = waiting_[--count_];
      if (!isWithin(next.squared)) continue;
      if (NormalConeTree::isLeaf(next.child)) {
        measure(NormalConeTree::leafIndex(next.child));
      } else {
        open(NormalConeTree::nodeIndex(next.child));
      }
    }
  }

 private:
  bool isWithin(float squared) const noexcept {
    return static_cast<double>(squared) < best_.distance * best_.distance;
  }

  void measure(std::uint32_t leaf) noexcept {
    const NormalConeTree::FaceLeaf& face = tree_.faces()[leaf];
    const auto x = tree_.positions();
    improve({x[face.corners[0]], x[face.corners[1]], x[face.corners[2]]}, face.face, point_, best_);
  }

  /// Lets the children of a node wait, the nearest on top.
  void open(std::uint32_t index) noexcept {
    const NormalConeTree::Node& node = tree_.nodes()[index];
    const std::array<float, kLanes> squared = boundsTo(node, single_, padding_);
    const std::size_t first = count_;
    for (std::size_t i = 0; i < kLanes; ++i) {
      const std::uint32_t child = node.child[i];
      if (child == NormalConeTree::kNoChild || isNoFace(child) || !isWithin(squared[i])) continue;
      std::size_t at = count_++;
      for (; at > first && waiting_[at - 1].squared < squared[i]; --at)
        waiting_[at] = waiting_[at - 1];
      waiting_[at] = {child, squared[i]};
    }
  }

  const NormalConeTree& tree_;
  const glm::dvec3& point_;
  const std::array<float, 3> single_;
  const float padding_;
  NearestPoint& best_;
  std::array<Waiting, kMaxWaiting> waiting_;
  std::size_t count_ = 0;
};

}  // namespace

NearestPoint nearestOnCorners(const TriangleCorners& corners, const glm::dvec3& point) noexcept {
  NearestPoint best = nearestOnSides(corners, point);
  best.triangle = 0;
  improve(corners, 0, point, best);
  return best;
}

NearestPoint PointDistance::nearest(const glm::dvec3& point, double within,
                                    std::uint32_t start) const noexcept {
  NearestPoint best;
  best.distance = within;
  const auto take = [&](std::uint32_t triangle) {
    NearestPoint found = nearestOnCorners(mesh_.corners(triangle), point);
    if (!(found.distance < best.distance)) return;
    best = found;
    best.triangle = triangle;
  };
  if (start < mesh_.mesh().triangles().size()) take(start);
  for (const std::uint32_t triangle : mesh_.looseTriangles())
    take(triangle);
  const NormalConeTree& tree = mesh_.tree();
  if (!tree.isEmpty()) {
    // The point found so far only bounds the search; it stays if nothing in the hierarchy is nearer.
    NearestPoint inTree;
    inTree.distance = best.distance;
    PointSearch(tree, point - tree.centre(), inTree).run();
    if (inTree.isFound()) {
      best = inTree;
      best.point += tree.centre();
    }
  }
  if (!best.isFound()) best.distance = std::numeric_limits<double>::infinity();
  return best;
}

}  // namespace nearfit
