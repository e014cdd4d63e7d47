#include "core/section/cut_plane.h"

#include <cmath>

#include <glm/geometric.hpp>

namespace nearfit {

CutPlane placed(const CutPlane& plane, const RigidTransform& frameFromPlane) noexcept {
  const glm::dvec3 normal = frameFromPlane.applyToVector(plane.normal);
  return {normal, plane.offset + glm::dot(normal, frameFromPlane.translation)};
}

std::array<glm::dvec3, 2> axesOf(const CutPlane& plane) noexcept {
  const glm::dvec3& n = plane.normal;
  const glm::dvec3 helper = std::abs(n.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  const glm::dvec3 first = glm::normalize(glm::cross(helper, n));
  return {first, glm::cross(n, first)};
}

std::array<glm::dvec3, 4> sheetOf(const CutPlane& plane, const Aabb& box) noexcept {
  const auto [right, up] = axesOf(plane);
  const auto [left, farRight] = reachAlong(box, right);
  const auto [low, high] = reachAlong(box, up);
  const glm::dvec3 origin = plane.offset * plane.normal;
  return {origin + left * right + low * up, origin + farRight * right + low * up,
          origin + farRight * right + high * up, origin + left * right + high * up};
}

std::pair<double, double> reachAlong(const Aabb& box, const glm::dvec3& direction) noexcept {
  const double middle = glm::dot(box.centre(), direction);
  const double half = 0.5 * glm::dot(box.upper - box.lower, glm::abs(direction));
  return {middle - half, middle + half};
}

}  // namespace nearfit
