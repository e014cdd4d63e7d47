// Finds cones and coarse cylinders among the facets of a mesh; declared in mesh_region.h.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "core/math/axes_across.h"
#include "core/math/symmetric_eigen.h"
#include "core/placing/mesh_region.h"
#include "core/placing/round_corners.h"

namespace nearfit {
namespace {

/// Max distance of corners from a cone, as a fraction of its radius: while it is only known from some facets, and
/// in the end. The latter is that of cylinders.
constexpr double kNearCone = 0.03, kOnCone = 2e-3;
/// Max deviation of a facet from the inclination that its width and the cone give it [sine of the angle]: likewise.
constexpr double kNearLean = 0.1, kOnLean = 5e-3;
/// On the way from the former to the latter: what blends into a wall is left behind bit by bit, and the fit with it.
constexpr std::array<std::pair<double, double>, 3> kTightening{{{0.012, 0.05}, {5e-3, 0.02}, {2.5e-3, 0.01}}};
/// Max angle between wall and axis [rad], 60 degrees. Beyond it a flat end would be within kNearLean of the wall.
constexpr double kMaxHalfAngle = std::numbers::pi / 3.0;
/// Max turn from a facet to the next around the axis [rad]: that of six equal flats.
constexpr double kMaxTurn = kPrismRing.widestFacet;
/// Facets that turn less are one flat face [rad].
constexpr double kMinTurn = 2e-3;
/// Facets beside the picked one that are tried, two at a time. A facet of a wall has two beside it and one at each
/// end; more only where its neighbours are cut finer.
constexpr std::size_t kMaxBeside = 8;
/// Max rounds of growing a region and fitting the cone anew.
constexpr int kMaxGrowths = 4;
/// Triangles that suffice to know a cone nearly, and corners to fit it to: more would only take time.
constexpr std::size_t kNearTriangles = 20'000, kFitted = 2'000;
constexpr std::size_t kFewestTriangles = 4;
/// Triangles that a wall of slivers is guessed from, and the least component of their normals along that of the picked
/// one: 60 degrees.
constexpr std::array<std::size_t, 2> kSlivers{16, 64};
constexpr double kAlike = 0.5;

/// Returns the flat facets beside one, across edges that may run along a round wall.
std::vector<std::vector<std::uint32_t>> facetsBeside(const TriangleMesh& mesh,
                                                     const std::vector<std::uint32_t>& facet) {
  std::unordered_set<std::uint32_t> seen(facet.begin(), facet.end());
  std::vector<std::vector<std::uint32_t>> beside;
  for (const std::uint32_t t : facet) {
    for (const std::uint32_t edge : mesh.edgesOfTriangle(t)) {
      if (!mesh.isEdgeConsistent(edge)) continue;
      const auto faces = mesh.facesOfEdge(edge);
      const std::uint32_t other = faces[0] == t ? faces[1] : faces[0];
      if (seen.contains(other)) continue;
      const glm::dvec3 a = triangleNormal(mesh, t), b = triangleNormal(mesh, other);
      const double turn = std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
      if (!(turn > kMinTurn && turn <= kMaxTurn)) continue;
      beside.push_back(facetOf(mesh, other));
      seen.insert(beside.back().begin(), beside.back().end());
      if (beside.size() == kMaxBeside) return beside;
    }
  }
  return beside;
}

/// Radius and slope of a cone about a given axis: the line through the points' distances from it.
std::optional<Cone> wallAbout(std::span<const glm::dvec3> points, const glm::dvec3& centre,
                              const glm::dvec3& axis) {
  Cone cone{centre, axis, 0.0, 0.0};
  double height = 0.0, away = 0.0, square = 0.0, product = 0.0;
  const auto count = static_cast<double>(points.size());
  const auto awayOf = [&](const glm::dvec3& p) { return glm::length(p - centre - cone.heightOf(p) * axis); };
  for (const glm::dvec3& p : points) {
    height += cone.heightOf(p) / count;
    away += awayOf(p) / count;
  }
  for (const glm::dvec3& p : points) {
    const double h = cone.heightOf(p) - height;
    square += h * h;
    product += h * (awayOf(p) - away);
  }
  if (square > 0.0) cone.slope = product / square;
  cone.radius = away - cone.slope * height;
  cone = cone.movedTo(height);
  return cone.radius > 0.0 ? std::optional(cone) : std::nullopt;
}

/// The cylinder whose axis is square to three facets' normals, or the cone whose axis they all lean against alike.
std::optional<Cone> coneByNormals(std::span<const glm::dvec3> points,
                                  const std::array<glm::dvec3, 3>& normals) {
  // Between directions that differ by the least turn.
  constexpr double kNoArea = 0.1 * kMinTurn * kMinTurn;
  const glm::dvec3 across = glm::cross(normals[1] - normals[0], normals[2] - normals[0]);
  const double length = glm::length(across);
  if (!(length > kNoArea)) return std::nullopt;
  const std::optional<Circle> circle = fitCylinder(points, across / length);
  if (!circle) return std::nullopt;
  return wallAbout(points, circle->centre, circle->axis);
}

/// The cone with its tip where the planes of three facets meet. Facets between lines along the wall meet there,
/// however unequal they are.
std::optional<Cone> coneByTip(std::span<const glm::dvec3> points, const std::array<glm::dvec3, 3>& normals,
                              const std::array<glm::dvec3, 3>& on) {
  constexpr double kParallel = 1e-9, kAtTip = 1e-3;
  const glm::dvec3 across = glm::cross(normals[1], normals[2]);
  const double volume = glm::dot(normals[0], across);
  if (!(std::abs(volume) > kParallel)) return std::nullopt;
  const glm::dvec3 tip = on[0] + (glm::dot(normals[1], on[1] - on[0]) * glm::cross(normals[2], normals[0]) +
                                  glm::dot(normals[2], on[2] - on[0]) * glm::cross(normals[0], normals[1])) /
                                     volume;
  double farthest = 0.0;
  for (const glm::dvec3& p : points)
    farthest = std::max(farthest, glm::distance(p, tip));
  std::vector<glm::dvec3> directions;
  glm::dvec3 mean(0.0);
  for (const glm::dvec3& p : points) {
    if (!(glm::distance(p, tip) > kAtTip * farthest)) continue;
    directions.push_back(glm::normalize(p - tip));
    mean += directions.back();
  }
  if (directions.size() < 3) return std::nullopt;
  mean /= static_cast<double>(directions.size());
  glm::dmat3 spread(0.0);
  for (const glm::dvec3& d : directions)
    spread += glm::outerProduct(d - mean, d - mean);
  // All lines along the wall make one angle with the axis: their directions end in a plane across it.
  return wallAbout(points, tip, symmetricEigen(spread).vectors[0]);
}

/// The cylinder, or steep cone, along the longest edge of a triangle. A wall that ends in a curve, as where two pipes
/// meet, is cut into slivers from end to end: two or three of them are as wide as rounding and say nothing of the axis,
/// but their long edges run along it, off by a sliver's width.
std::optional<Cone> coneAlongEdge(const TriangleMesh& mesh, std::uint32_t first, std::size_t most) {
  glm::dvec3 along(0.0);
  const Triangle& c = mesh.triangles()[first];
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 edge = mesh.vertices()[c[(k + 1) % 3]] - mesh.vertices()[c[k]];
    if (glm::length(edge) > glm::length(along)) along = edge;
  }
  along = glm::normalize(along);
  const glm::dvec3 normal = triangleNormal(mesh, first);
  const auto isBeside = [&](std::uint32_t t) {
    const glm::dvec3 other = triangleNormal(mesh, t);
    return glm::dot(other, normal) > kAlike && std::abs(glm::dot(other, along)) <= kNearLean;
  };
  const std::vector<glm::dvec3> points = cornersOf(mesh, grownRegion(mesh, first, isBeside, most));
  const std::optional<Circle> circle = fitCylinder(points, along);
  if (!circle) return std::nullopt;
  return fitCone(points, Cone{circle->centre, circle->axis, circle->radius, 0.0}, true);
}

/// Triangles on a cone, connected to the first.
class ConeGrower {
 public:
  ConeGrower(const TriangleMesh& mesh, std::uint32_t first, const Cone& cone)
      : mesh_(mesh),
        first_(first),
        cone_(cone),
        across_(axesAcross(cone.axis)),
        isOutside_(isOutside(first)) {}

  /// @param share, lean  See kOnCone, kOnLean.
  std::vector<std::uint32_t> grow(double share, double lean,
                                  std::size_t most = TriangleMesh::kMaxTriangles) const {
    // Single precision, as for cylinders.
    const double slack = share * cone_.radius + 1e-7 * mesh_.bounds().diagonal();
    const auto accepts = [&](std::uint32_t t) {
      for (const std::uint32_t v : mesh_.triangles()[t]) {
        if (!(cone_.distanceFrom(mesh_.vertices()[v]) <= slack)) return false;
      }
      return isOutside(t) == isOutside_ &&
             std::abs(glm::dot(triangleNormal(mesh_, t), cone_.axis) - leanOf(t)) <= lean;
    };
    if (!accepts(first_)) return {};
    return grownRegion(mesh_, first_, accepts, most);
  }

 private:
  glm::dvec2 aside(const glm::dvec3& p) const {
    return {glm::dot(p - cone_.centre, across_[0]), glm::dot(p - cone_.centre, across_[1])};
  }
  bool isOutside(std::uint32_t t) const {
    const Triangle& c = mesh_.triangles()[t];
    const glm::dvec3 middle =
        (mesh_.vertices()[c[0]] + mesh_.vertices()[c[1]] + mesh_.vertices()[c[2]]) / 3.0;
    const glm::dvec3 away = middle - cone_.centre - cone_.heightOf(middle) * cone_.axis;
    return glm::dot(triangleNormal(mesh_, t), away) > 0.0;
  }
  /// Component of a facet's normal along the axis, for a flat facet between two lines along the wall.
  double leanOf(std::uint32_t t) const {
    double width = 0.0;
    const Triangle& c = mesh_.triangles()[t];
    for (std::size_t k = 0; k < 3; ++k) {
      const glm::dvec2 a = aside(mesh_.vertices()[c[k]]), b = aside(mesh_.vertices()[c[(k + 1) % 3]]);
      // A corner at the tip has no angle.
      if (glm::length(a) > kTip * cone_.radius && glm::length(b) > kTip * cone_.radius)
        width = std::max(width, std::abs(std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b))));
    }
    const double tilt = cone_.slope * std::cos(0.5 * width);
    return (isOutside_ ? -1.0 : 1.0) * tilt / std::sqrt(1.0 + tilt * tilt);
  }

  static constexpr double kTip = 1e-3;
  const TriangleMesh& mesh_;
  std::uint32_t first_;
  Cone cone_;
  std::array<glm::dvec3, 2> across_;
  bool isOutside_;
};

/// Fits a cone to corners, or to as many of them as suffice.
std::optional<Cone> fittedTo(const std::vector<glm::dvec3>& corners, const Cone& guess,
                             bool isCylinder = false) {
  const std::size_t stride = corners.size() / kFitted + 1;
  if (stride == 1) return fitCone(corners, guess, isCylinder);
  std::vector<glm::dvec3> some;
  for (std::size_t i = 0; i < corners.size(); i += stride)
    some.push_back(corners[i]);
  return fitCone(some, guess, isCylinder);
}

bool isSteepEnough(const Cone& cone) {
  return cone.halfAngle() <= kMaxHalfAngle;
}

bool isRoundWall(const std::vector<double>& lines, bool isPrism) {
  return isPrism ? isRing(lines, kPrismRing) : isRing(lines, kRoundRing) || isFineArc(lines);
}

/// Grows a region on the cone, fitting that to it on the way.
std::optional<ConeRegion> grownFrom(const TriangleMesh& mesh, std::uint32_t first, Cone cone, bool isPrism) {
  std::size_t before = 0;
  for (int round = 0; round < kMaxGrowths; ++round) {
    if (!isSteepEnough(cone)) return std::nullopt;
    const std::vector<std::uint32_t> near =
        ConeGrower(mesh, first, cone).grow(kNearCone, kNearLean, kNearTriangles);
    if (near.size() < kFewestTriangles) return std::nullopt;
    const std::optional<Cone> better = fittedTo(cornersOf(mesh, near), cone);
    if (!better) return std::nullopt;
    cone = *better;
    if (near.size() == std::exchange(before, near.size())) break;
  }
  for (const auto& [share, lean] : kTightening) {
    const std::vector<std::uint32_t> nearer = ConeGrower(mesh, first, cone).grow(share, lean, kNearTriangles);
    if (nearer.size() >= kFewestTriangles) cone = fittedTo(cornersOf(mesh, nearer), cone).value_or(cone);
  }
  ConeRegion region{{}, cone, 0};
  if (isSteepEnough(cone)) region.triangles = ConeGrower(mesh, first, cone).grow(kOnCone, kOnLean);
  if (region.triangles.size() < kFewestTriangles) return std::nullopt;
  // A wall that is as well a cylinder is one.
  const auto cylinder = fittedTo(cornersOf(mesh, region.triangles), cone, true);
  if (cylinder) {
    std::vector<std::uint32_t> straight = ConeGrower(mesh, first, *cylinder).grow(kOnCone, kOnLean);
    if (straight.size() >= region.triangles.size()) region = {std::move(straight), *cylinder, 0};
  }
  if (isPrism && region.cone.slope != 0.0) return std::nullopt;
  const std::vector<glm::dvec3> corners = cornersOf(mesh, region.triangles);
  region.cone = fittedTo(corners, region.cone, region.cone.slope == 0.0).value_or(region.cone);
  const std::vector<double> lines = linesAbout(corners, region.cone.centre, region.cone.axis);
  if (!isRoundWall(lines, isPrism)) return std::nullopt;
  region.facets = lines.size();
  const auto [lowest, highest] =
      std::ranges::minmax(corners, {}, [&](const glm::dvec3& p) { return region.cone.heightOf(p); });
  region.cone = region.cone.movedTo(0.5 * (region.cone.heightOf(lowest) + region.cone.heightOf(highest)));
  return region;
}

}  // namespace

std::optional<ConeRegion> coneRegion(const TriangleMesh& mesh, std::uint32_t triangle, bool isPrism) {
  const std::vector<std::uint32_t> facet = facetOf(mesh, triangle);
  if (facet.empty()) return std::nullopt;
  const std::vector<std::vector<std::uint32_t>> beside = facetsBeside(mesh, facet);
  std::optional<ConeRegion> best;
  const auto take = [&](std::optional<ConeRegion> found) {
    if (found && (!best || found->triangles.size() > best->triangles.size())) best = std::move(found);
  };
  const auto tryFrom = [&](const std::optional<Cone>& guess, std::span<const glm::dvec3> points) {
    if (!guess || !isSteepEnough(*guess)) return;
    const Cone cone = fitCone(points, *guess).value_or(*guess);
    const bool isNear = std::ranges::all_of(
        points, [&](const glm::dvec3& p) { return cone.distanceFrom(p) <= kNearCone * cone.radius; });
    if (!isNear) return;
    take(grownFrom(mesh, triangle, cone, isPrism));
  };
  const auto pointOn = [&](std::uint32_t t) { return mesh.vertices()[mesh.triangles()[t][0]]; };
  for (std::size_t i = 0; i < beside.size(); ++i) {
    for (std::size_t j = i + 1; j < beside.size(); ++j) {
      std::vector<std::uint32_t> three = facet;
      three.insert(three.end(), beside[i].begin(), beside[i].end());
      three.insert(three.end(), beside[j].begin(), beside[j].end());
      const std::vector<glm::dvec3> points = cornersOf(mesh, three);
      const std::array<glm::dvec3, 3> normals{triangleNormal(mesh, triangle),
                                              triangleNormal(mesh, beside[i].front()),
                                              triangleNormal(mesh, beside[j].front())};
      tryFrom(coneByNormals(points, normals), points);
      const std::array<glm::dvec3, 3> on{pointOn(triangle), pointOn(beside[i].front()),
                                         pointOn(beside[j].front())};
      tryFrom(coneByTip(points, normals, on), points);
    }
  }
  for (const std::size_t most : kSlivers) {
    // Three facets may also be a small piece of something else.
    if (best && best->triangles.size() > most) break;
    if (const std::optional<Cone> guess = coneAlongEdge(mesh, triangle, most))
      take(grownFrom(mesh, triangle, *guess, isPrism));
  }
  return best;
}

}  // namespace nearfit
