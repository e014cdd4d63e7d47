#include "core/proximity/surface/outer_windings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include <glm/geometric.hpp>

#include "core/exact/triangle_predicates.h"

namespace nearfit {
namespace {

constexpr std::size_t kMaxPatches = 1000;
/// Max number of triangles through which a line on another one is followed: each is compared with each.
constexpr std::size_t kMaxInLine = 64;
/// Max number of triangles of a patch to try.
constexpr std::size_t kMaxTries = 16;
/// Max number of rays from a point. A ray is unclear only if it hits an edge to the last bit.
constexpr int kMaxWindingRays = 16;
/// Distance of a point from its triangle, as a fraction of the triangle's size: the first is usually near
/// enough for nothing to lie between, the last is as near as rounding allows.
constexpr double kOffsets[]{1e-3, 1e-5, 1e-7, 1e-9};
/// Max number of nodes of the boxes' hierarchy that all rays together look at: some seconds.
constexpr std::uint64_t kMaxNodes = 20'000'000;
/// How far rays stray from an axis, as a fraction of their length: clear of edges along it, in a thin box.
constexpr double kStray = 1e-3;

class OuterWindings {
 public:
  OuterWindings(const TriangleMesh& mesh, const MeshComponents& pieces, const PieceBoxes& boxes,
                std::span<const CrossingPair> crossings)
      : mesh_(mesh), pieces_(pieces), boxes_(boxes) {
    for (const auto& [a, b] : crossings) {
      partners_.push_back({a, b});
      partners_.push_back({b, a});
    }
    std::ranges::sort(partners_);
  }

  bool arePositive() {
    if (!makePatches()) return false;
    for (const std::vector<std::uint32_t>& patch : patches_) {
      const std::optional<int> winding = outside(patch);
      if (!winding || *winding < 0) return false;
      windings_.push_back(*winding);
    }
    for (auto at = partners_.begin(); at != partners_.end();) {
      const auto end = std::find_if(at, partners_.end(), [&](const auto& p) { return p[0] != (*at)[0]; });
      if (!isPositiveOn((*at)[0], {at, end})) return false;
      at = end;
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max(), kCrossed = kNone - 1;

  /// Finds the patches of the components that cross themselves. False if there are too many.
  bool makePatches() {
    patchOf_.assign(mesh_.triangles().size(), kNone);
    std::vector<bool> isCrossed(pieces_.firstTriangle.size(), false);
    for (const auto& [triangle, partner] : partners_) {
      patchOf_[triangle] = kCrossed;
      isCrossed[pieces_.pieceOf[triangle]] = true;
    }
    for (std::uint32_t first = 0; first < patchOf_.size(); ++first) {
      if (patchOf_[first] != kNone || !isCrossed[pieces_.pieceOf[first]]) continue;
      if (patches_.size() == kMaxPatches) return false;
      fillPatch(first);
    }
    return true;
  }

  /// Keeps only as many triangles of a patch as are to be tried.
  void fillPatch(std::uint32_t first) {
    const auto number = static_cast<std::uint32_t>(patches_.size());
    std::vector<std::uint32_t>& patch = patches_.emplace_back();
    std::vector<std::uint32_t> waiting{first};
    patchOf_[first] = number;
    while (!waiting.empty()) {
      const std::uint32_t triangle = waiting.back();
      waiting.pop_back();
      if (patch.size() < kMaxTries) patch.push_back(triangle);
      for (const std::uint32_t edge : mesh_.edgesOfTriangle(triangle)) {
        for (const std::uint32_t next : mesh_.facesOfEdge(edge)) {
          if (patchOf_[next] != kNone) continue;
          patchOf_[next] = number;
          waiting.push_back(next);
        }
      }
    }
  }

  /// Winding number of the component just outside a patch.
  std::optional<int> outside(const std::vector<std::uint32_t>& patch) {
    for (const std::uint32_t triangle : patch) {
      const std::optional<glm::dvec3> point = pointOutside(triangle);
      if (!point) continue;
      if (const auto winding = windingAt(*point, pieces_.pieceOf[triangle])) return winding;
    }
    return std::nullopt;
  }

  /// Returns a point on the triangle's outer side with nothing of the component between the two.
  std::optional<glm::dvec3> pointOutside(std::uint32_t triangle) {
    const TriangleCorners t = cornersOf(mesh_, triangle);
    const glm::dvec3 middle = (t[0] + t[1] + t[2]) / 3.0, across = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double area = glm::length(across);
    if (!(area > 0.0)) return std::nullopt;
    for (const double offset : kOffsets) {
      if (nodes_ >= kMaxNodes) break;
      const glm::dvec3 step = offset / std::sqrt(area) * across;
      const glm::dvec3 from = middle + step, to = middle - step;
      if (crossingOf(from, to, t) != Crossing::In) continue;
      bool isFree = true;
      visitAt(from, to, pieces_.pieceOf[triangle], [&](std::uint32_t other) {
        isFree = isFree && (other == triangle || !doTrianglesMeet({from, to, to}, cornersOf(mesh_, other)));
      });
      if (isFree) return from;
    }
    return std::nullopt;
  }

  /// No value also if all rays have taken too much work.
  std::optional<int> windingAt(const glm::dvec3& point, std::uint32_t piece) {
    const Aabb& box = mesh_.bounds();
    const double stray = kStray * box.diagonal();
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> some(-stray, stray);
    for (int i = 0; i < kMaxWindingRays && nodes_ < kMaxNodes; ++i) {
      const int axis = i % 3;
      glm::dvec3 end = point + glm::dvec3(some(random), some(random), some(random));
      const bool isUp = end[axis] > box.centre()[axis];
      end[axis] = isUp ? box.upper[axis] + box.diagonal() : box.lower[axis] - box.diagonal();
      int windings = 0;
      bool isClear = true;
      visitAt(point, end, piece, [&](std::uint32_t triangle) {
        const Crossing crossing = crossingOf(point, end, cornersOf(mesh_, triangle));
        windings += crossing == Crossing::Out ? 1 : crossing == Crossing::In ? -1 : 0;
        isClear = isClear && crossing != Crossing::Unclear;
      });
      if (isClear) return windings;
    }
    return std::nullopt;
  }

  /// Calls visit(triangle) for each triangle of a component that a segment may meet.
  template <class Visit>
  void visitAt(const glm::dvec3& from, const glm::dvec3& to, std::uint32_t piece, Visit&& visit) {
    Aabb box;
    box.add(from);
    box.add(to);
    nodes_ += boxes_.forEachAt(piece, box, visit);
  }

  /// True if the winding number is nowhere negative just outside a triangle that others cross.
  bool isPositiveOn(std::uint32_t triangle, std::span<const CrossingPair> crossings) const {
    const TriangleCorners t = cornersOf(mesh_, triangle);
    if (hasNoArea(t)) return true;
    std::vector<TriangleCorners> passing;
    for (const auto& [self, other] : crossings) {
      const TriangleCorners corners = cornersOf(mesh_, other);
      // A coplanar triangle does not come between points just outside.
      const auto isInPlane = [&](const glm::dvec3& p) { return sideOf(p, corners) == 0; };
      if (!std::ranges::all_of(t, isInPlane)) passing.push_back(corners);
    }
    const bool isCutOnce = isCutInTwo(triangle, crossings);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto faces = mesh_.facesOfEdge(mesh_.edgesOfTriangle(triangle)[k]);
      const std::uint32_t patch = patchOf_[faces[0] == triangle ? faces[1] : faces[0]];
      if (patch == kCrossed) continue;
      const int winding = windings_[patch];
      const glm::dvec3 &a = t[k], &b = t[(k + 1) % 3], &c = t[(k + 2) % 3];
      if (winding >= countBehind(a, b, passing) || winding >= countBehind(b, a, passing)) return true;
      if (isCutOnce && (winding > 0 || isEntered(a, c, passing) || isEntered(b, c, passing))) return true;
    }
    return false;
  }

  /// True if the triangles that cross a triangle do so in one line, which cuts it in two: each is in general
  /// position, none crosses another, and neighbours share sides that pass through the triangle. The line does
  /// not end within the triangle since the mesh is closed.
  bool isCutInTwo(std::uint32_t triangle, std::span<const CrossingPair> crossings) const {
    if (crossings.size() > kMaxInLine) return false;
    std::vector<std::uint32_t> waiting{crossings[0][1]}, joined = waiting;
    for (const auto& [self, other] : crossings) {
      if (!isInGeneralPosition(triangle, other)) return false;
      for (const auto& [same, second] : crossings) {
        if (std::ranges::binary_search(partners_, CrossingPair{other, second})) return false;
      }
    }
    const TriangleCorners t = cornersOf(mesh_, triangle);
    while (!waiting.empty()) {
      const std::uint32_t at = waiting.back();
      waiting.pop_back();
      for (const std::uint32_t edge : mesh_.edgesOfTriangle(at)) {
        const MeshEdge& e = mesh_.edges()[edge];
        if (!isThrough(crossingOf(mesh_.vertices()[e.v0], mesh_.vertices()[e.v1], t))) continue;
        for (const std::uint32_t next : mesh_.facesOfEdge(edge)) {
          if (std::ranges::find(joined, next) != joined.end()) continue;
          joined.push_back(next);
          waiting.push_back(next);
        }
      }
    }
    return joined.size() == crossings.size();
  }

  static bool isThrough(Crossing crossing) { return crossing == Crossing::In || crossing == Crossing::Out; }

  /// True if no corner of either triangle lies in the other's plane and no side of one meets an edge of the
  /// other. Then at most two sides pass through.
  bool isInGeneralPosition(std::uint32_t first, std::uint32_t second) const {
    const TriangleCorners a = cornersOf(mesh_, first), b = cornersOf(mesh_, second);
    const auto isClear = [](const TriangleCorners& corners, const TriangleCorners& other) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (sideOf(corners[k], other) == 0) return false;
        if (crossingOf(corners[k], corners[(k + 1) % 3], other) == Crossing::Unclear) return false;
      }
      return true;
    };
    return isClear(a, b) && isClear(b, a);
  }

  /// True if exactly one of the passing triangles crosses a side, from its front: the winding number behind
  /// it is larger by one.
  static bool isEntered(const glm::dvec3& from, const glm::dvec3& to,
                        std::span<const TriangleCorners> passing) {
    int in = 0, through = 0;
    for (const TriangleCorners& corners : passing) {
      const Crossing crossing = crossingOf(from, to, corners);
      in += crossing == Crossing::In ? 1 : 0;
      through += isThrough(crossing) ? 1 : 0;
    }
    return in == 1 && through == 1;
  }

  /// Number of triangles that a point of a side, near its end, is not in front of: no more can be passed from
  /// behind on the way to any point.
  static int countBehind(const glm::dvec3& end, const glm::dvec3& other,
                         std::span<const TriangleCorners> passing) {
    return static_cast<int>(std::ranges::count_if(passing, [&](const TriangleCorners& corners) {
      const int side = sideOf(end, corners);
      return side < 0 || (side == 0 && sideOf(other, corners) <= 0);
    }));
  }

  const TriangleMesh& mesh_;
  const MeshComponents& pieces_;
  const PieceBoxes& boxes_;
  std::uint64_t nodes_ = 0;             ///< Looked at by all rays so far.
  std::vector<CrossingPair> partners_;  ///< Each crossing in both orders, sorted.
  std::vector<std::uint32_t> patchOf_;
  std::vector<std::vector<std::uint32_t>> patches_;  ///< Some triangles of each patch.
  std::vector<int> windings_;                        ///< By patch.
};

}  // namespace

bool areOuterWindingsPositive(const TriangleMesh& mesh, const MeshComponents& pieces, const PieceBoxes& boxes,
                              std::span<const CrossingPair> crossings) {
  return OuterWindings(mesh, pieces, boxes, crossings).arePositive();
}

}  // namespace nearfit
