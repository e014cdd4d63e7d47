#include "core/placing/view_projection.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace nearfit {
namespace {

/// A unit vector perpendicular to another.
glm::dvec3 squareTo(const glm::dvec3& unit) {
  const glm::dvec3 other = std::abs(unit.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(unit, other));
}

}  // namespace

ViewProjection::ViewProjection(const Camera& camera, const glm::dvec2& size)
    : camera_(camera),
      size_(size.x > 0.0 ? size.x : 1.0, size.y > 0.0 ? size.y : 1.0),
      away_(glm::normalize(camera.away)),
      slope_(std::tan(0.5 * camera.viewAngle)) {
  const glm::dvec3 across = glm::cross(away_, camera.up);
  right_ = glm::length(across) > 1e-12 * glm::length(camera.up) ? glm::normalize(across) : squareTo(away_);
  up_ = glm::cross(right_, away_);
}

double ViewProjection::depthOf(const glm::dvec3& point) const noexcept {
  return glm::dot(point - camera_.eye, away_);
}

glm::dvec3 ViewProjection::sightOf(const glm::dvec3& point) const noexcept {
  const glm::dvec3 sight = point - camera_.eye;
  const double length = glm::length(sight);
  return camera_.isParallel || !(length > 0.0) ? away_ : sight / length;
}

double ViewProjection::metresPerPixel(const glm::dvec3& point) const noexcept {
  const double half = camera_.isParallel ? camera_.halfHeight : depthOf(point) * slope_;
  return std::max(2.0 * half / size_.y, 0.0);
}

std::optional<glm::dvec2> ViewProjection::pixelOf(const glm::dvec3& point) const noexcept {
  const double scale = metresPerPixel(point);
  if (!(scale > 0.0)) return std::nullopt;
  const glm::dvec3 fromEye = point - camera_.eye;
  return 0.5 * size_ + glm::dvec2(glm::dot(fromEye, right_), -glm::dot(fromEye, up_)) / scale;
}

ViewRay ViewProjection::rayThrough(const glm::dvec2& pixel) const noexcept {
  const glm::dvec2 off = (pixel - 0.5 * size_) * (2.0 / size_.y);
  if (camera_.isParallel) {
    return {camera_.eye + camera_.halfHeight * (off.x * right_ - off.y * up_), away_};
  }
  return {camera_.eye, glm::normalize(away_ + slope_ * (off.x * right_ - off.y * up_))};
}

}  // namespace nearfit
