#include "core/placing/measure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/math/nearest_on_segment.h"
#include "core/placing/surface_pairs.h"

namespace nearfit {
namespace {

glm::dvec3 nearestOnEdge(const TriangleMesh& mesh, const PickedFeature& edge, const glm::dvec3& point) {
  const auto vertices = mesh.vertices();
  glm::dvec3 nearest = vertices[edge.vertices.front()];
  for (std::size_t i = 1; i < edge.vertices.size(); ++i) {
    const glm::dvec3 on = nearestOnSegment(vertices[edge.vertices[i - 1]], vertices[edge.vertices[i]], point);
    if (glm::distance(on, point) < glm::distance(nearest, point)) nearest = on;
  }
  return nearest;
}

bool isPlane(const AlignFeature& feature) noexcept {
  return feature.shape == FeatureShape::Plane;
}
bool isPoint(const AlignFeature& feature) noexcept {
  return feature.shape == FeatureShape::Point;
}

/// Between lines, regardless of sign [rad].
double angleBetween(const glm::dvec3& a, const glm::dvec3& b) noexcept {
  return std::atan2(glm::length(glm::cross(a, b)), std::abs(glm::dot(a, b)));
}

/// From a point to a plane or a line [m].
double distanceTo(const AlignFeature& feature, const glm::dvec3& point) noexcept {
  const glm::dvec3 off = point - feature.point;
  return isPlane(feature) ? std::abs(glm::dot(off, feature.direction))
                          : glm::length(glm::cross(off, feature.direction));
}

/// Makes a measurement between parallel planes one along their normal.
void alignWithNormal(const AlignFeature& a, const AlignFeature& b, Measurement& measurement) noexcept {
  const double ahead = glm::dot(b.point - a.point, a.direction);
  measurement.pointToPoint = measurement.distance;
  measurement.to = measurement.from + ahead * a.direction;
  measurement.distance = std::abs(ahead);
  if (glm::dot(a.direction, b.direction) < 0.0) measurement.gap = ahead;
}

glm::dvec3 footOnLine(const AlignFeature& line, const glm::dvec3& point) noexcept {
  return line.point + glm::dot(point - line.point, line.direction) * line.direction;
}
glm::dvec3 footOnPlane(const AlignFeature& plane, const glm::dvec3& point) noexcept {
  return point - glm::dot(point - plane.point, plane.direction) * plane.direction;
}

/// Makes a measurement between an axis and a parallel axis or plane one along their common perpendicular, where the
/// first axis was clicked.
void alignWithPerpendicular(const MeasureEnd& from, const MeasureEnd& to, Measurement& measurement) noexcept {
  const AlignFeature &a = from.feature, &b = to.feature;
  measurement.pointToPoint = measurement.distance;
  // A click on the wall of a bore is not on its axis.
  if (isPlane(a)) {
    measurement.to = footOnLine(b, to.point);
    measurement.from = footOnPlane(a, measurement.to);
  } else {
    measurement.from = footOnLine(a, from.point);
    measurement.to = isPlane(b) ? footOnPlane(b, measurement.from) : footOnLine(b, measurement.from);
  }
  measurement.distance = glm::distance(measurement.from, measurement.to);
  // Almost parallel ones are not as far apart everywhere.
  measurement.apart = measurement.distance;
}

/// Rounding of where a foot lies, as a share of the edge's length: across from its end it is on the edge.
constexpr double kFootRounding = 1e-9;

/// The extent of a straight edge along its feature's direction.
glm::dvec2 extentOf(const TriangleMesh& mesh, const PickedFeature& edge) {
  const auto along = [&](std::uint32_t vertex) {
    return glm::dot(mesh.vertices()[vertex] - edge.feature.point, edge.feature.direction);
  };
  const double first = along(edge.vertices.front()), last = along(edge.vertices.back());
  return {std::min(first, last), std::max(first, last)};
}

bool isCentre(const AlignFeature& feature) noexcept {
  return isPoint(feature) || feature.shape == FeatureShape::Circle;
}

/// Measures from a corner or centre to an edge's line. Where the point lies beside the edge, the measurement ends at the
/// foot, wherever the edge was clicked.
/// @param onEdge  End of `measurement` at the edge.
void measureToEdge(const glm::dvec3& centre, const MeasureEnd& edge, glm::dvec3& onEdge,
                   Measurement& measurement) noexcept {
  measurement.apart = distanceTo(edge.feature, centre);
  const double along = glm::dot(centre - edge.feature.point, edge.feature.direction);
  const double rounding = kFootRounding * (edge.extent->y - edge.extent->x);
  if (along < edge.extent->x - rounding || along > edge.extent->y + rounding) return;
  measurement.pointToPoint = measurement.distance;
  measurement.distance = *measurement.apart;
  onEdge = footOnLine(edge.feature, centre);
}

}  // namespace

MeasureEnd measureEnd(const TriangleMesh& mesh, const PickedFeature& picked, const glm::dvec3& hit,
                      const SurfaceFaces* surfaces) {
  const FeatureShape shape = picked.feature.shape;
  if (shape == FeatureShape::Point || shape == FeatureShape::Circle)
    return {picked.feature.point, picked.feature};
  if (!picked.vertices.empty())
    return {nearestOnEdge(mesh, picked, hit), picked.feature, extentOf(mesh, picked)};
  const bool isOnFace = surfaces != nullptr && picked.feature.isExact && !picked.triangles.empty();
  if (!isOnFace) return {hit, picked.feature};
  // The faces that are picked together are on one surface.
  const std::uint32_t face = surfaces->faceOfTriangle[picked.triangles.front()];
  return {nearestOnSurface(surfaces->faces[face], hit), picked.feature};
}

Measurement measure(const MeasureEnd& from, const MeasureEnd& to) noexcept {
  Measurement result;
  result.from = from.point;
  result.to = to.point;
  result.distance = glm::distance(from.point, to.point);
  const AlignFeature &a = from.feature, &b = to.feature;
  if (isPoint(a) && isPoint(b)) return result;
  const bool isToEdge = isCentre(a) && to.extent, isFromEdge = isCentre(b) && from.extent;
  if (isToEdge) measureToEdge(from.point, to, result.to, result);
  if (isFromEdge) measureToEdge(to.point, from, result.from, result);
  if (isPoint(a) || isPoint(b)) {
    if (isToEdge || isFromEdge) return result;
    result.apart = isPoint(a) ? distanceTo(b, from.point) : distanceTo(a, to.point);
    return result;
  }
  const bool isMixed = isPlane(a) != isPlane(b);
  const double between = angleBetween(a.direction, b.direction);
  result.angle = isMixed ? 0.5 * std::numbers::pi - between : between;
  if (isToEdge || isFromEdge) return result;
  const bool hasCentre = a.shape == FeatureShape::Circle || b.shape == FeatureShape::Circle;
  if (!(isMixed && hasCentre) && *result.angle > kParallelAngle) return result;
  // For a plane and a line, measure from the line to the plane.
  result.apart = isPlane(a) ? distanceTo(a, b.point) : distanceTo(b, a.point);
  if (isPlane(a) && isPlane(b)) alignWithNormal(a, b, result);
  // Centres of circles stay what they are: two on one axis are a depth apart.
  if (!hasCentre && !(isPlane(a) && isPlane(b))) alignWithPerpendicular(from, to, result);
  return result;
}

}  // namespace nearfit
