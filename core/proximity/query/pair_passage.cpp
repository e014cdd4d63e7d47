#include "core/proximity/query/pair_passage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/nearest_on_segment.h"
#include "core/math/tolerances.h"
#include "core/proximity/query/query_workspace.h"
#include "core/proximity/query/triangle_distance.h"

namespace nearfit {
namespace {

/// Roundings of a coordinate in a distance along a direction, each of both poses and features counted.
constexpr double kRoundings = 32.0;

/// Nearest point of a triangle.
glm::dvec3 nearestOnTriangle(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& point) noexcept {
  const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  glm::dvec3 nearest = corners[0];
  double least = std::numeric_limits<double>::infinity();
  bool isInside = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::dvec3 &a = corners[k], &b = corners[(k + 1) % 3];
    if (glm::dot(glm::cross(normal, b - a), point - a) >= 0.0) continue;
    isInside = false;
    const glm::dvec3 at = nearestOnSegment(a, b, point), apart = point - at;
    const double squared = glm::dot(apart, apart);
    if (squared < least) {
      least = squared;
      nearest = at;
    }
  }
  const double squared = glm::dot(normal, normal);
  if (!isInside || !(squared > 0.0)) return nearest;
  return point - glm::dot(point - corners[0], normal) / squared * normal;
}

}  // namespace

PairPassage::PairPassage(const NormalConeTree& scene, const NormalConeTree& part, const PartWay& way,
                         double enough) noexcept
    : scene_(scene), part_(part), travel_(way.travel), enough_(enough) {
  const RigidTransform from = centredPose(scene, part, way.from), to = centredPose(scene, part, way.to);
  turnFrom_ = glm::mat3_cast(from.rotation);
  turnTo_ = glm::mat3_cast(to.rotation);
  shiftFrom_ = from.translation;
  shiftTo_ = to.translation;
  const double lengths =
      scene.size() + part.size() + std::max(glm::length(shiftFrom_), glm::length(shiftTo_));
  lost_ = way.bend + kRoundings * kPointRounding * lengths;
}

PairPassage::Corners PairPassage::cornersOf(const NormalConeTree& tree, std::uint32_t leaf) noexcept {
  const std::uint32_t i = NormalConeTree::leafIndex(leaf);
  const std::span<const glm::dvec3> at = tree.positions();
  switch (NormalConeTree::leafKind(leaf)) {
    case FeatureKind::Vertex: {
      const glm::dvec3& v = at[tree.vertices()[i].vertex];
      return {{v, v, v}, 1};
    }
    case FeatureKind::Edge: {
      const NormalConeTree::EdgeLeaf& edge = tree.edges()[i];
      return {{at[edge.v0], at[edge.v1], at[edge.v1]}, 2};
    }
    case FeatureKind::Face:
      break;
  }
  const Triangle& corners = tree.faces()[i].corners;
  return {{at[corners[0]], at[corners[1]], at[corners[2]]}, 3};
}

PairPassage::Corners PairPassage::placed(const Corners& corners, const glm::dmat3& turn,
                                         const glm::dvec3& shift) noexcept {
  Corners out = corners;
  for (std::size_t k = 0; k < corners.count; ++k)
    out.at[k] = turn * corners.at[k] + shift;
  for (std::size_t k = corners.count; k < out.at.size(); ++k)
    out.at[k] = out.at[k - 1];
  return out;
}

double PairPassage::leastOf(const LeafPair& pair) const noexcept {
  const Corners scene = cornersOf(scene_, pair.scene), part = cornersOf(part_, pair.part);
  const Corners from = placed(part, turnFrom_, shiftFrom_), to = placed(part, turnTo_, shiftTo_);
  // How far the part's feature is beyond the scene's along a direction of any length, at both ends.
  const auto apartAlong = [&](const glm::dvec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 0.0)) return -std::numeric_limits<double>::infinity();
    const glm::dvec3 n = direction / length;
    const auto extent = [&](const Corners& c) {
      const double a = glm::dot(n, c.at[0]), b = glm::dot(n, c.at[1]), d = glm::dot(n, c.at[2]);
      return std::array{std::min({a, b, d}), std::max({a, b, d})};
    };
    const auto [low, high] = extent(scene);
    const auto [lowFrom, highFrom] = extent(from);
    const auto [lowTo, highTo] = extent(to);
    return std::max(std::min(lowFrom, lowTo) - high, low - std::max(highFrom, highTo));
  };
  double least = -std::numeric_limits<double>::infinity();
  const auto tries = [&](const glm::dvec3& direction) {
    least = std::max(least, apartAlong(direction) - lost_);
    return least > enough_;
  };
  // First the directions that take no search: a face's normal, or what is perpendicular to both edges.
  if (scene.count == 3) {
    if (tries(glm::cross(scene.at[1] - scene.at[0], scene.at[2] - scene.at[0]))) return least;
  } else if (part.count == 3) {
    if (tries(glm::cross(to.at[1] - to.at[0], to.at[2] - to.at[0]))) return least;
  } else if (scene.count == 2 && part.count == 2) {
    if (tries(glm::cross(scene.at[1] - scene.at[0], to.at[1] - to.at[0]))) return least;
  }
  const auto between = [&](const Corners& moved) -> glm::dvec3 {
    if (scene.count == 3) return moved.at[0] - nearestOnTriangle(scene.at, moved.at[0]);
    if (moved.count == 3) return nearestOnTriangle(moved.at, scene.at[0]) - scene.at[0];
    const ClosestPoints found = closestOfSegments(scene.at[0], scene.at[1], moved.at[0], moved.at[1]);
    return found.b - found.a;
  };
  const glm::dvec3 apart = between(to);
  if (tries(apart) || tries(between(from))) return least;
  // However it goes, the part moves no farther than it travels.
  return std::max(least, glm::length(apart) - travel_ - lost_);
}

double PairPassage::leastOf(std::span<const LeafPair> pairs) const noexcept {
  double least = std::numeric_limits<double>::infinity();
  for (const LeafPair& pair : pairs)
    least = std::min(least, leastOf(pair));
  return least;
}

}  // namespace nearfit
