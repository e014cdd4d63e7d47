#include "core/placing/gizmo_drag.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/math/rotation_vector.h"
#include "core/placing/gizmo_layout.h"

namespace nearfit {
namespace {

/// Below this sine between axis and sight (1 degree), the axis is end on: the pointer would cross the view
/// for a small step.
constexpr double kEndOn = 0.0175;
/// A plane seen at less than about 9 degrees is edge on [sine].
constexpr double kOnEdge = 0.15;
/// Below this sine between a ray and a plane, where they meet is unreliable.
constexpr double kGrazing = 0.02;
/// Max pointer travel toward an axis's vanishing point, as a fraction of the way.
constexpr double kVanishing = 0.98;

double rounded(double value, double step) noexcept {
  return step > 0.0 ? step * std::round(value / step) : value;
}

glm::dvec3 axisIn(const GizmoFrame& frame, GizmoGrip handle, const ViewProjection& view) noexcept {
  const int axis = axisOf(handle);
  if (axis >= 0) return frame.axes[axis];
  // Toward the viewer, so that anticlockwise on the screen is a positive rotation.
  return handle == GizmoGrip::TurnView ? -view.sightOf(frame.pivot) : -view.away();
}

/// Zero direction for angles about an axis; unit.
glm::dvec3 zeroArm(const glm::dvec3& axis) noexcept {
  const glm::dvec3 helper = std::abs(axis.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  return glm::normalize(glm::cross(axis, helper));
}

}  // namespace

GizmoDrag::GizmoDrag(const ViewProjection& view, const GizmoFrame& frame, GizmoGrip handle,
                     const glm::dvec2& pixel, const std::optional<glm::dvec3>& grabbed)
    : frame_(frame),
      handle_(handle),
      axis_(axisIn(frame, handle, view)),
      anchor_(grabbed && handle == GizmoGrip::MoveFree ? *grabbed : frame.pivot),
      pressed_(pixel) {
  const double facing = std::abs(glm::dot(axis_, view.sightOf(anchor_)));
  isOnEdge_ = !isArrow(handle) && facing < kOnEdge;
  if (isArrow(handle)) {
    along_ = alongAtStart_ = alongAxis(view, pixel).value_or(0.0);
  } else if (!isRing(handle)) {
    onPlane_ = onPlaneAtStart_ = onPlane(view, pixel).value_or(anchor_);
  } else if (isOnEdge_) {
    grabRingOnEdge(view);
  } else {
    lastAngle_ = angleAt(view, pixel).value_or(0.0);
    grabbedArm_ = glm::angleAxis(lastAngle_, axis_) * zeroArm(axis_);
  }
}

/// Position along the axis of the point whose image is nearest to the pixel [m]. The image of the axis is a
/// line; std::nullopt if it is a point.
std::optional<double> GizmoDrag::alongAxis(const ViewProjection& view,
                                           const glm::dvec2& pixel) const noexcept {
  const std::optional<glm::dvec2> origin = view.pixelOf(anchor_);
  if (!origin) return std::nullopt;
  const double scale = view.metresPerPixel(anchor_), depth = view.depthOf(anchor_);
  const double deeper = view.isParallel() ? 0.0 : glm::dot(axis_, view.away()) / depth;
  // Image velocity of a point that starts along the axis [pixel/m].
  const glm::dvec2 flat = glm::dvec2(glm::dot(axis_, view.right()), -glm::dot(axis_, view.up())) / scale;
  const glm::dvec2 speed = flat - deeper * (*origin - view.middle());
  const double rate = glm::length(speed);
  if (!(rate * scale > kEndOn)) return std::nullopt;
  const double along = glm::dot(pixel - *origin, speed) / rate;
  // The image of anchor + t axis is at rate t / (1 + deeper t) along the line.
  const double vanishing = deeper != 0.0 ? rate / deeper : 0.0;
  double reached = along;
  if (deeper > 0.0) reached = std::min(along, kVanishing * vanishing);
  if (deeper < 0.0) reached = std::max(along, kVanishing * vanishing);
  return reached / (rate - deeper * reached);
}

/// Point of the plane under the pointer; std::nullopt if it is behind the eye or the angle is too flat.
std::optional<glm::dvec3> GizmoDrag::onPlane(const ViewProjection& view,
                                             const glm::dvec2& pixel) const noexcept {
  const ViewRay ray = view.rayThrough(pixel);
  const double before = glm::dot(axis_, view.sightOf(anchor_)), now = glm::dot(axis_, ray.direction);
  if (!(std::abs(now) > kGrazing) || now * before < 0.0) return std::nullopt;
  const double distance = glm::dot(anchor_ - ray.origin, axis_) / now;
  if (!view.isParallel() && !(distance > 0.0)) return std::nullopt;
  return ray.origin + distance * ray.direction;
}

/// The pointer's way in the view plane, projected onto the plane seen edge on.
glm::dvec3 GizmoDrag::acrossView(const ViewProjection& view, const glm::dvec2& pixel) const noexcept {
  const glm::dvec2 way = view.metresPerPixel(anchor_) * (pixel - pressed_);
  const glm::dvec3 inView = way.x * view.right() - way.y * view.up();
  return inView - glm::dot(inView, axis_) * axis_;
}

std::optional<double> GizmoDrag::angleAt(const ViewProjection& view, const glm::dvec2& pixel) const noexcept {
  const std::optional<glm::dvec3> point = onPlane(view, pixel);
  if (!point) return std::nullopt;
  const glm::dvec3 arm = *point - anchor_;
  // At the ring's centre, the angle is undefined.
  if (!(glm::length(arm) > view.metresPerPixel(anchor_))) return std::nullopt;
  const glm::dvec3 first = zeroArm(axis_), second = glm::cross(axis_, first);
  return std::atan2(glm::dot(arm, second), glm::dot(arm, first));
}

/// A ring edge on is a line on the screen; the pointer rolls it like a thumb wheel.
void GizmoDrag::grabRingOnEdge(const ViewProjection& view) noexcept {
  const glm::dvec3 along = glm::cross(axis_, -view.sightOf(anchor_));
  glm::dvec2 onScreen(glm::dot(along, view.right()), -glm::dot(along, view.up()));
  const double length = glm::length(onScreen);
  if (length > 0.0) tangent_ = onScreen / (length * GizmoLayout::kRingRadius);
  grabbedArm_ = length > 0.0 ? glm::normalize(glm::cross(along, axis_)) : zeroArm(axis_);
}

void GizmoDrag::moveTo(const ViewProjection& view, const glm::dvec2& pixel) {
  if (std::isfinite(pixel.x + pixel.y)) follow(view, pixel);
}

void GizmoDrag::follow(const ViewProjection& view, const glm::dvec2& pixel) noexcept {
  if (isArrow(handle_)) {
    along_ = alongAxis(view, pixel).value_or(along_);
  } else if (!isRing(handle_)) {
    onPlane_ =
        isOnEdge_ ? onPlaneAtStart_ + acrossView(view, pixel) : onPlane(view, pixel).value_or(onPlane_);
  } else if (isOnEdge_) {
    turned_ = glm::dot(pixel - pressed_, tangent_);
  } else if (const std::optional<double> now = angleAt(view, pixel)) {
    turned_ += std::remainder(*now - lastAngle_, 2.0 * std::numbers::pi);
    lastAngle_ = *now;
  }
}

glm::dvec3 GizmoDrag::shift(const SnapSteps& steps) const noexcept {
  if (isRing(handle_)) return glm::dvec3(0.0);
  if (isArrow(handle_)) return (amount_ ? *amount_ : rounded(along_ - alongAtStart_, steps.length)) * axis_;
  const glm::dvec3 way = onPlane_ - onPlaneAtStart_;
  const double length = glm::length(way);
  if (amount_) return length > 0.0 ? *amount_ / length * way : glm::dvec3(0.0);
  if (!(steps.length > 0.0)) return way;
  glm::dvec3 snapped(0.0);
  for (int i = 0; i < 3; ++i) {
    // Snapping must not leave the plane of a square.
    if (isPlane(handle_) && i == axisOf(handle_)) continue;
    snapped += rounded(glm::dot(way, frame_.axes[i]), steps.length) * frame_.axes[i];
  }
  return snapped;
}

double GizmoDrag::angle(const SnapSteps& steps) const noexcept {
  if (!isRing(handle_)) return 0.0;
  return amount_ ? *amount_ : rounded(turned_, steps.angle);
}

glm::dvec3 GizmoDrag::shiftIn(const RigidTransform& motion) const noexcept {
  return isRing(handle_) ? glm::dvec3(0.0) : motion.applyToPoint(frame_.pivot) - frame_.pivot;
}

double GizmoDrag::angleIn(const RigidTransform& motion) const noexcept {
  if (!isRing(handle_)) return 0.0;
  constexpr double kRound = 2.0 * std::numbers::pi;
  const double angle = glm::dot(rotationVector(motion.rotation), axis_);
  return angle + kRound * std::round((amount_.value_or(turned_) - angle) / kRound);
}

RigidTransform GizmoDrag::motion(const SnapSteps& steps) const noexcept {
  if (!isRing(handle_)) return {glm::dquat(1.0, 0.0, 0.0, 0.0), shift(steps)};
  const glm::dquat turn = glm::angleAxis(angle(steps), axis_);
  return {turn, frame_.pivot - turn * frame_.pivot};
}

}  // namespace nearfit
