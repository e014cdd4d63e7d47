#include "core/mesh/features.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <glm/geometric.hpp>

#include "core/math/extreme_directions.h"
#include "core/math/min_norm_point.h"
#include "core/math/tolerances.h"
#include "core/mesh/flat_groups.h"

namespace nearfit {
namespace {

/// Dihedral angles within this of straight count as flat [rad]. A dropped flat edge leaves a gap between its
/// faces of this times the distance, which is below the slack of the leaf tests.
constexpr double kFlat = 1e-11;

/// A triangle lower than this fraction of its longest side has no reliable normal in double precision.
constexpr double kNoArea = 1e-14;

/// Directions in thinner triangles are computed in extended precision. Otherwise rounding could turn the
/// edges around them convex or reflex.
constexpr double kThin = 1e-3;

/// Max error of the axis of a polar cone as narrow as the angular tolerance [rad].
constexpr double kAxisRounding = 1e-5;

/// Directions whose cosine is smaller count as perpendicular. Used only to build bounds.
constexpr double kSquare = 1e-6;

/// Approximate progress after the faces and after the edges, and the number of features between two reports
/// (some milliseconds).
constexpr double kFacesTaken = 0.05, kEdgesTaken = 0.5;
constexpr std::uint32_t kBetweenReports = 8192;

std::optional<glm::dvec3> unit(const glm::dvec3& v) {
  const double length = glm::length(v);
  if (!(length > 0.0)) return std::nullopt;
  return v / length;
}

using Extended = glm::tvec3<long double>;

/// Unit direction from an edge to a point, perpendicular to the edge; std::nullopt if the point lies on it.
/// @param along  Unit direction of the edge.
/// @param w      From the edge's start to the point.
std::optional<glm::dvec3> squareToEdge(const glm::dvec3& edge, const glm::dvec3& along, const glm::dvec3& w) {
  const glm::dvec3 t = w - glm::dot(w, along) * along;
  if (glm::dot(t, t) > kThin * kThin * glm::dot(w, w)) return unit(t);
  const Extended e(edge), x(w);
  return unit(glm::dvec3(x - e * (glm::dot(x, e) / glm::dot(e, e))));
}

class FeatureFinder {
 public:
  FeatureFinder(const TriangleMesh& mesh, const std::function<void(double)>& onProgress,
                std::span<const std::uint32_t> flatOf)
      : mesh_(mesh),
        onProgress_(onProgress),
        x_(mesh.vertices()),
        flatOf_(flatOf),
        normals_(mesh.triangles().size()) {}

  MeshFeatures find() {
    forAll(mesh_.triangles().size(), 0.0, kFacesTaken, [this](std::uint32_t f) { addFace(f); });
    forAll(mesh_.edges().size(), kFacesTaken, kEdgesTaken, [this](std::uint32_t e) { addEdge(e); });
    forAll(mesh_.vertices().size(), kEdgesTaken, 1.0, [this](std::uint32_t v) { addVertex(v); });
    return std::move(out_);
  }

 private:
  /// In-face direction perpendicular to an edge and pointing into the face, and the face's third corner.
  struct Wing {
    glm::dvec3 inward;
    std::uint32_t opposite;
    std::uint32_t face;
  };

  template <class Add>
  void forAll(std::size_t count, double from, double to, Add add) const {
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i % kBetweenReports == 0 && onProgress_)
        onProgress_(from + (to - from) * static_cast<double>(i) / static_cast<double>(count));
      add(i);
    }
    if (onProgress_) onProgress_(to);
  }

  bool hasArea(std::uint32_t f) const { return normals_[f] != glm::dvec3(0.0); }

  /// True if a face at the edge has an area. Edges only between faces without area are ignored.
  bool isSurface(std::uint32_t edge) const {
    return std::ranges::any_of(mesh_.facesOfEdge(edge), [this](std::uint32_t f) { return hasArea(f); });
  }

  void addFace(std::uint32_t f) {
    const Triangle& t = mesh_.triangles()[f];
    const glm::dvec3 e0 = x_[t[1]] - x_[t[0]], e1 = x_[t[2]] - x_[t[1]], e2 = x_[t[0]] - x_[t[2]];
    const glm::dvec3 normal = glm::cross(e0, -e2);
    const double longest = std::max({glm::dot(e0, e0), glm::dot(e1, e1), glm::dot(e2, e2)});
    const double length = glm::length(normal);
    if (!(length > kNoArea * longest)) return;
    normals_[f] = normal / length;
    out_.faces.push_back({f, {normals_[f], 0.0}});
  }

  std::vector<Wing> wingsOf(std::uint32_t e, const glm::dvec3& along) const {
    std::vector<Wing> wings;
    const MeshEdge& edge = mesh_.edges()[e];
    for (const std::uint32_t f : mesh_.facesOfEdge(e)) {
      if (!hasArea(f)) continue;
      for (const std::uint32_t corner : mesh_.triangles()[f]) {
        if (corner == edge.v0 || corner == edge.v1) continue;
        const auto inward = squareToEdge(x_[edge.v1] - x_[edge.v0], along, x_[corner] - x_[edge.v0]);
        if (inward) wings.push_back({*inward, corner, f});
      }
    }
    return wings;
  }

  /// The two wings that enclose all others, if all fit in less than half a turn: the sides of the widest gap.
  static std::optional<std::array<Wing, 2>> boundingWings(std::vector<Wing>& wings, const glm::dvec3& along) {
    const glm::dvec3 u = wings[0].inward, v = glm::cross(along, u);
    const auto angle = [&](const Wing& w) {
      return std::atan2(glm::dot(w.inward, v), glm::dot(w.inward, u));
    };
    std::sort(wings.begin(), wings.end(), [&](const Wing& a, const Wing& b) { return angle(a) < angle(b); });
    double widest = -1.0;
    std::array<Wing, 2> sides{wings[0], wings[0]};
    for (std::size_t i = 0; i < wings.size(); ++i) {
      const Wing& next = wings[(i + 1) % wings.size()];
      const double wrap = i + 1 == wings.size() ? 2.0 * std::numbers::pi : 0.0;
      const double gap = angle(next) + wrap - angle(wings[i]);
      if (gap > widest) {
        widest = gap;
        sides = {next, wings[i]};
      }
    }
    if (widest <= std::numbers::pi + kFlat) return std::nullopt;
    return sides;
  }

  bool runsAlong(std::uint32_t face, const MeshEdge& edge) const {
    const Triangle& t = mesh_.triangles()[face];
    return (t[0] == edge.v0 && t[1] == edge.v1) || (t[1] == edge.v0 && t[2] == edge.v1) ||
           (t[2] == edge.v0 && t[0] == edge.v1);
  }

  bool isInsideFlat(std::uint32_t e) const {
    if (flatOf_.empty() || !mesh_.isEdgeConsistent(e)) return false;
    const auto faces = mesh_.facesOfEdge(e);
    return flatOf_[faces[0]] != kNoFlat && flatOf_[faces[0]] == flatOf_[faces[1]];
  }

  void addEdge(std::uint32_t e) {
    if (isInsideFlat(e)) return;
    const MeshEdge& edge = mesh_.edges()[e];
    const auto along = unit(x_[edge.v1] - x_[edge.v0]);
    if (!along) return;
    std::vector<Wing> wings = wingsOf(e, *along);
    if (wings.empty()) return;
    const bool hasSide = wings.size() == 2 && mesh_.isEdgeConsistent(e);
    if (hasSide) {
      // The face's normal is less accurate than its inward direction if the face is thin.
      const glm::dvec3 outward =
          (runsAlong(wings[0].face, edge) ? 1.0 : -1.0) * glm::cross(*along, wings[0].inward);
      const double rise = glm::dot(wings[1].inward, outward);
      const bool isFolded = glm::dot(wings[0].inward, wings[1].inward) > 0.0;
      if (isFolded ? rise > kFlat : rise > -kFlat) return;  // Reflex or flat.
    }
    const auto sides = boundingWings(wings, *along);
    if (!sides) return;
    const auto& [a, b] = *sides;
    const double between = angleBetween(a.inward, b.inward);
    const auto axis = unit(-(a.inward + b.inward));
    if (!axis) return;
    out_.edges.push_back({e, {a.opposite, b.opposite}, {*axis, 0.5 * (std::numbers::pi - between)}});
  }

  /// Angle-weighted pseudonormal of a vertex; std::nullopt if the surface around it has no side.
  std::optional<glm::dvec3> pseudonormal(std::uint32_t v) const {
    const auto edges = mesh_.edgesOfVertex(v);
    for (const std::uint32_t e : edges) {
      if (!mesh_.isEdgeConsistent(e)) return std::nullopt;
    }
    // Walk once around the vertex: where two fans touch, the surface has no side.
    glm::dvec3 normal(0.0);
    std::uint32_t edge = edges[0], face = mesh_.facesOfEdge(edge)[0];
    std::size_t walked = 0;
    do {
      normal += cornerAngle(face, v) * normals_[face];
      edge = otherEdgeAt(v, face, edge);
      const auto faces = mesh_.facesOfEdge(edge);
      face = faces[0] == face ? faces[1] : faces[0];
      ++walked;
    } while (edge != edges[0] && walked <= edges.size());
    if (walked != edges.size()) return std::nullopt;
    return normal;
  }

  std::uint32_t otherEdgeAt(std::uint32_t v, std::uint32_t face, std::uint32_t edge) const {
    for (const std::uint32_t e : mesh_.edgesOfTriangle(face)) {
      const MeshEdge& candidate = mesh_.edges()[e];
      if (e != edge && (candidate.v0 == v || candidate.v1 == v)) return e;
    }
    return edge;
  }

  double cornerAngle(std::uint32_t face, std::uint32_t v) const {
    if (!hasArea(face)) return 0.0;
    const Triangle& t = mesh_.triangles()[face];
    const std::size_t k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    const auto a = unit(x_[t[(k + 1) % 3]] - x_[v]), b = unit(x_[t[(k + 2) % 3]] - x_[v]);
    return a && b ? angleBetween(*a, *b) : 0.0;
  }

  void addVertex(std::uint32_t v) {
    directions_.clear();
    neighbours_.clear();
    for (const std::uint32_t e : mesh_.edgesOfVertex(v)) {
      if (!isSurface(e)) continue;
      const std::uint32_t other = mesh_.edges()[e].v0 == v ? mesh_.edges()[e].v1 : mesh_.edges()[e].v0;
      if (const auto direction = unit(x_[other] - x_[v])) {
        directions_.push_back(*direction);
        neighbours_.push_back(other);
      }
    }
    if (directions_.empty()) return;
    // The direction inside the polar cone farthest from its walls. That distance is the distance of the hull
    // of edge directions from the origin.
    const glm::dvec3 nearest = minNormPoint(directions_);
    const double width = glm::length(nearest);
    if (!(width > kAngularTolerance)) return;  // No interior.
    const glm::dvec3 inside = nearest / -width;
    const auto normal = pseudonormal(v);
    // In a pit, the polar cone lies in the material. For a folded sheet, the pseudonormal is mere rounding.
    if (normal && glm::dot(*normal, inside) < -kAngularTolerance) return;

    double depth = 1.0;
    for (const glm::dvec3& e : directions_)
      depth = std::min(depth, -glm::dot(e, inside));
    // In the narrowest cones, rounding leaves no direction certainly inside from which to see the walls.
    const bool isInsideSure = depth > 0.5 * width;
    std::vector<std::size_t> walls(directions_.size());
    std::iota(walls.begin(), walls.end(), std::size_t{0});
    if (isInsideSure) walls = extremeDirections(directions_, -inside);
    const auto count = static_cast<std::uint32_t>(walls.size());
    out_.vertices.push_back({v, static_cast<std::uint32_t>(out_.neighbours.size()), count,
                             isInsideSure ? count : 0, polarCone(inside, walls, isInsideSure)});
    for (const std::size_t i : walls)
      out_.neighbours.push_back(neighbours_[i]);
  }

  NormalCone polarCone(const glm::dvec3& inside, const std::vector<std::size_t>& extreme,
                       bool isInsideSure) const {
    // All polar directions are within a right angle of `inside`, because it is minus a sum of the edges.
    if (!isInsideSure) return {inside, 0.5 * std::numbers::pi + kAxisRounding};
    const NormalCone widest{inside, 0.5 * std::numbers::pi};
    if (extreme.size() < 3) return widest;
    std::vector<NormalCone> rays;
    for (std::size_t i = 0; i < extreme.size(); ++i) {
      const glm::dvec3 &a = directions_[extreme[i]], &b = directions_[extreme[(i + 1) % extreme.size()]];
      const auto ray = unit(glm::cross(a, b));
      // The sign of a ray perpendicular to `inside` is uncertain.
      if (!ray || std::abs(glm::dot(*ray, inside)) < kSquare) return widest;
      rays.push_back({glm::dot(*ray, inside) < 0.0 ? -*ray : *ray, 0.0});
    }
    const NormalCone bound = boundingCone(rays);
    return bound.halfAngle < widest.halfAngle ? bound : widest;
  }

  const TriangleMesh& mesh_;
  const std::function<void(double)>& onProgress_;
  std::span<const glm::dvec3> x_;
  std::span<const std::uint32_t> flatOf_;
  std::vector<glm::dvec3> normals_;  ///< Zero for faces without area.
  MeshFeatures out_;
  std::vector<glm::dvec3> directions_;
  std::vector<std::uint32_t> neighbours_;
};

}  // namespace

MeshFeatures findFeatures(const TriangleMesh& mesh, const std::function<void(double)>& onProgress,
                          std::span<const std::uint32_t> flatOf) {
  return FeatureFinder(mesh, onProgress, flatOf).find();
}

}  // namespace nearfit
