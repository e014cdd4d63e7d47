#include "core/verdict/surface_depth.h"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/math/aabb.h"
#include "core/proximity/overlap/containment.h"
#include "core/proximity/overlap/placed_mesh.h"
#include "core/proximity/surface/point_distance.h"

namespace nearfit {
namespace {

constexpr double kAnywhere = std::numeric_limits<double>::infinity();
/// The depth is known once its bounds are this share apart: no press fit is specified more finely.
constexpr double kDepthShare = 0.01;
/// Points between two questions if the search goes on: some milliseconds.
constexpr std::uint64_t kBetweenAnswers = 512;

/// A body that another one's surface may lie in, in its own frame.
class DepthTarget {
 public:
  explicit DepthTarget(const NormalConeTree& tree)
      : mesh_(tree, nullptr), pieces_(piecesOf(tree.mesh())), solid_(mesh_, pieces_), distance_(mesh_) {}

  bool contains(const glm::dvec3& point) const { return solid_.contains(point); }
  NearestPoint nearest(const glm::dvec3& point) const { return distance_.nearest(point, kAnywhere); }
  TriangleCorners corners(std::uint32_t triangle) const { return mesh_.corners(triangle); }

 private:
  PlacedMesh mesh_;
  MeshComponents pieces_;
  PlacedSolid solid_;
  PointDistance distance_;
};

/// A piece of a surface, in the target's frame.
struct SurfacePiece {
  TriangleCorners corners;
  const DepthTarget* target;
  double most;                                  ///< No point of it is deeper [m].
  std::uint32_t nearest = NearestPoint::kNone;  ///< Triangle of the target that is nearest to its middle.
  bool operator<(const SurfacePiece& other) const noexcept { return most < other.most; }
};

/// A convex piece of a plane.
using SurfacePolygon = std::vector<glm::dvec3>;

/// Parts of a polygon beyond a plane by less than this share of the plane's side are not cut off: rounding.
constexpr double kSmallestCut = 1e-9;

/// Cuts a polygon along a plane through `point`: what is in front goes to `front`, the rest stays. False if the plane
/// leaves it whole, to within `slack`.
bool cutOff(const glm::dvec3& normal, const glm::dvec3& point, double slack, SurfacePolygon& polygon,
            SurfacePolygon& front) {
  double lowest = 0.0, highest = 0.0;
  for (const glm::dvec3& p : polygon) {
    lowest = std::min(lowest, glm::dot(normal, p - point));
    highest = std::max(highest, glm::dot(normal, p - point));
  }
  if (highest <= slack || lowest >= -slack) return false;
  SurfacePolygon behind;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double a = glm::dot(normal, p - point), b = glm::dot(normal, q - point);
    (a > 0.0 ? front : behind).push_back(p);
    if ((a > 0.0) == (b > 0.0)) continue;
    const glm::dvec3 between = p + a / (a - b) * (q - p);
    front.push_back(between);
    behind.push_back(between);
  }
  polygon = std::move(behind);
  return true;
}

class DeepestPoint {
 public:
  DeepestPoint(double within, std::uint64_t maxSamples, const std::function<bool()>& goOn)
      : within_(within), maxSamples_(maxSamples), goOn_(goOn) {}

  /// Adds the pieces of a surface that reach into the target's box.
  void addSurface(const NormalConeTree& surface, const NormalConeTree& body, const DepthTarget& target,
                  const RigidTransform& targetFromSurface) {
    const PlacedMesh placed(surface, &targetFromSurface);
    for (std::uint32_t i = 0; i < surface.mesh().triangles().size() && !isSpent(); ++i) {
      const TriangleCorners corners = placed.corners(i);
      if (doOverlap(boxOf(corners), body.mesh().bounds())) look({corners, &target, kAnywhere});
    }
    if (isSpent()) isCut_ = true;
  }

  SurfaceDepth run() {
    while (!isKnown() && !isSpent()) {
      const SurfacePiece piece = pieces_.top();
      pieces_.pop();
      split(piece);
    }
    return {least_, isCut_ ? kAnywhere : pieces_.empty() ? least_ : std::max(least_, pieces_.top().most)};
  }

 private:
  bool isKnown() const {
    return (within_ > 0.0 && least_ > within_) || pieces_.empty() ||
           pieces_.top().most <= std::max((1.0 + kDepthShare) * least_, within_);
  }
  bool isSpent() const noexcept { return isStopped_ || samples_ >= maxSamples_; }

  /// Finds bounds on the depth of a piece, and keeps it if it may hold a deeper point.
  void look(SurfacePiece piece) {
    if (++samples_ % kBetweenAnswers == 0 && goOn_ && !goOn_()) isStopped_ = true;
    const TriangleCorners& t = piece.corners;
    const glm::dvec3 middle = (t[0] + t[1] + t[2]) / 3.0;
    const double radius =
        std::max({glm::distance(middle, t[0]), glm::distance(middle, t[1]), glm::distance(middle, t[2])});
    const NearestPoint nearest = piece.target->nearest(middle);
    if (!nearest.isFound()) return;
    // A point on the surface is neither inside nor outside.
    const bool isInside = nearest.distance > 0.0 && piece.target->contains(middle);
    const double depth = isInside ? nearest.distance : -nearest.distance;
    least_ = std::max(least_, depth);
    // No point is deeper than its distance to any one triangle, which over a triangle is largest at a corner.
    const TriangleCorners near = piece.target->corners(nearest.triangle);
    double toNear = 0.0;
    for (const glm::dvec3& corner : t)
      toNear = std::max(toNear, nearestOnCorners(near, corner).distance);
    piece.most = std::min({piece.most, depth + radius, toNear});
    piece.nearest = nearest.triangle;
    if (piece.most > least_) pieces_.push(piece);
  }

  /// Cuts a piece where the triangle that is nearest to its middle ends, seen from the side: what is left over that
  /// triangle has a bound that is hardly more than its depth.
  void split(const SurfacePiece& piece) {
    const TriangleCorners over = piece.target->corners(piece.nearest);
    const glm::dvec3 normal = glm::cross(over[1] - over[0], over[2] - over[0]);
    SurfacePolygon inside(piece.corners.begin(), piece.corners.end());
    bool isCut = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec3 side = over[(k + 1) % 3] - over[k];
      const glm::dvec3 across = glm::cross(side, normal);
      const double length = glm::length(across);
      if (!(length > 0.0)) continue;
      SurfacePolygon outside;
      if (!cutOff(across / length, over[k], kSmallestCut * glm::length(side), inside, outside)) continue;
      isCut = true;
      lookAtAll(outside, piece);
    }
    isCut ? lookAtAll(inside, piece) : quarter(piece);
  }

  void lookAtAll(const SurfacePolygon& polygon, const SurfacePiece& whole) {
    for (std::size_t i = 2; i < polygon.size(); ++i)
      look({{polygon[0], polygon[i - 1], polygon[i]}, whole.target, whole.most});
  }

  void quarter(const SurfacePiece& piece) {
    const TriangleCorners& t = piece.corners;
    const std::array<glm::dvec3, 3> middles{0.5 * (t[0] + t[1]), 0.5 * (t[1] + t[2]), 0.5 * (t[2] + t[0])};
    for (const TriangleCorners& part :
         {TriangleCorners{t[0], middles[0], middles[2]}, TriangleCorners{middles[0], t[1], middles[1]},
          TriangleCorners{middles[2], middles[1], t[2]}, middles})
      look({part, piece.target, piece.most});
  }

  double within_;
  std::uint64_t maxSamples_, samples_ = 0;
  const std::function<bool()>& goOn_;
  bool isStopped_ = false, isCut_ = false;
  double least_ = 0.0;
  std::priority_queue<SurfacePiece> pieces_;
};

}  // namespace

SurfaceDepth findSurfaceDepth(const NormalConeTree& scene, const NormalConeTree& part,
                              const RigidTransform& sceneFromPart, double within, std::uint64_t maxSamples,
                              const std::function<bool()>& goOn) {
  const DepthTarget inScene(scene), inPart(part);
  DeepestPoint search(within, maxSamples, goOn);
  search.addSurface(part, scene, inScene, sceneFromPart);
  search.addSurface(scene, part, inPart, sceneFromPart.inverse());
  return search.run();
}

}  // namespace nearfit
