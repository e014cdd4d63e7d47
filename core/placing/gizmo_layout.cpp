#include "core/placing/gizmo_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <ranges>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "core/placing/gizmo_drag.h"

namespace nearfit {
namespace {

/// Start of shafts, size of arrow heads, and extent of squares [pixels].
constexpr double kShaftFrom = 14.0, kHeadLength = 17.0, kHeadRadius = 6.0;
constexpr double kSquareFrom = 27.0, kSquareTo = 49.0;
/// Arrows and squares fade between these sines of the angle to the sight, and vanish below.
constexpr double kArrowGone = 0.14, kArrowWhole = 0.28, kSquareGone = 0.12, kSquareWhole = 0.28;
/// Max distance at which the pointer is on a line [pixels].
constexpr double kOnLine = 3.0;
/// Min opacity of what can be grabbed.
constexpr double kMinGrabbed = 0.35;
/// The far side of a ring is faint, unless the ring is seen as a circle.
constexpr double kFarOpacity = 0.38, kRound = 0.9, kQuiteRound = 0.98;
constexpr int kArcPoints = 48;
/// Reach of an axis's guide line [pixels].
constexpr double kGuideReach = 4096.0;

double ramp(double value, double from, double to) {
  return std::clamp((value - from) / (to - from), 0.0, 1.0);
}

/// An arc about `centre`, at angles from `first` toward `second`, which is perpendicular to it.
std::vector<glm::dvec2> arc(const ViewProjection& view, const glm::dvec3& centre, const glm::dvec3& first,
                            const glm::dvec3& second, double from, double to) {
  std::vector<glm::dvec2> points;
  for (int i = 0; i <= kArcPoints; ++i) {
    const double angle = from + (to - from) * i / kArcPoints;
    const auto pixel = view.pixelOf(centre + std::cos(angle) * first + std::sin(angle) * second);
    if (pixel) points.push_back(*pixel);
  }
  return points;
}

std::vector<glm::dvec2> pixelsOf(const ViewProjection& view, std::span<const glm::dvec3> points) {
  std::vector<glm::dvec2> pixels;
  for (const glm::dvec3& point : points) {
    if (const auto pixel = view.pixelOf(point)) pixels.push_back(*pixel);
  }
  return pixels;
}

/// Two unit vectors perpendicular to `unit` and to each other.
std::array<glm::dvec3, 2> across(const glm::dvec3& unit) {
  const glm::dvec3 helper = std::abs(unit.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 first = glm::normalize(glm::cross(unit, helper));
  return {first, glm::cross(unit, first)};
}

double distanceToSegment(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& point) noexcept {
  const glm::dvec2 way = b - a;
  const double lengthSquared = glm::dot(way, way);
  const double share =
      lengthSquared > 0.0 ? std::clamp(glm::dot(point - a, way) / lengthSquared, 0.0, 1.0) : 0.0;
  return glm::distance(point, a + share * way);
}

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) noexcept {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

}  // namespace

GizmoLayout::GizmoLayout(const ViewProjection& view, const GizmoFrame& frame, GizmoMode mode) {
  if (mode == GizmoMode::Hidden || !view.pixelOf(frame.pivot)) return;
  if (axisOf(mode) >= 0) {
    addRings(view, frame, axisOf(mode));
    addArrow(view, frame, axisOf(mode), kLongArrowLength);
    return;
  }
  const bool hasRings = mode != GizmoMode::Move, hasArrows = mode != GizmoMode::Turn;
  if (hasRings) addRings(view, frame);
  if (mode == GizmoMode::Turn) addViewRing(view, frame);
  if (!hasArrows) return;
  const double length = hasRings ? kLongArrowLength : kArrowLength;
  addArrows(view, frame, length, Side::Far);
  addPlanes(view, frame);
  addArrows(view, frame, length, Side::Near);
  addMiddle(view, frame);
}

void GizmoLayout::addArrow(const ViewProjection& view, const GizmoFrame& frame, int axis, double length) {
  const double scale = view.metresPerPixel(frame.pivot);
  const glm::dvec3 unit = frame.axes[axis];
  const double sine = glm::length(glm::cross(unit, view.sightOf(frame.pivot)));
  const double opacity = ramp(sine, kArrowGone, kArrowWhole);
  if (opacity == 0.0) return;
  const GizmoGrip handle = kArrows[static_cast<std::size_t>(axis)];
  const glm::dvec3 base = frame.pivot + scale * (length - kHeadLength) * unit;
  const std::array shaft{frame.pivot + scale * kShaftFrom * unit, base};
  figures_.push_back({handle, pixelsOf(view, shaft), false, opacity, false});
  const auto [first, second] = across(unit);
  std::vector<glm::dvec2> head =
      arc(view, base, scale * kHeadRadius * first, scale * kHeadRadius * second, 0.0, 2.0 * std::numbers::pi);
  if (const auto tip = view.pixelOf(frame.pivot + scale * length * unit)) head.push_back(*tip);
  figures_.push_back({handle, convexHull(std::move(head)), true, opacity, false});
}

void GizmoLayout::addArrows(const ViewProjection& view, const GizmoFrame& frame, double length, Side side) {
  const glm::dvec3 sight = view.sightOf(frame.pivot);
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, std::greater<>(), [&](int axis) { return glm::dot(frame.axes[axis], sight); });
  for (const int axis : order) {
    if ((glm::dot(frame.axes[axis], sight) > 0.0) == (side == Side::Far)) addArrow(view, frame, axis, length);
  }
}

void GizmoLayout::addPlanes(const ViewProjection& view, const GizmoFrame& frame) {
  const double scale = view.metresPerPixel(frame.pivot);
  const glm::dvec3 sight = view.sightOf(frame.pivot);
  for (int axis = 0; axis < 3; ++axis) {
    const double opacity = ramp(std::abs(glm::dot(frame.axes[axis], sight)), kSquareGone, kSquareWhole);
    if (opacity == 0.0) continue;
    // In the quadrant nearest to the viewer, where nothing hides it.
    const auto towardsViewer = [&](int other) {
      const glm::dvec3 unit = frame.axes[other];
      return scale * (glm::dot(unit, sight) <= 0.0 ? unit : -unit);
    };
    const glm::dvec3 a = towardsViewer((axis + 1) % 3), b = towardsViewer((axis + 2) % 3);
    const std::array corners{
        frame.pivot + kSquareFrom * a + kSquareFrom * b, frame.pivot + kSquareTo * a + kSquareFrom * b,
        frame.pivot + kSquareTo * a + kSquareTo * b, frame.pivot + kSquareFrom * a + kSquareTo * b};
    figures_.push_back(
        {kPlanes[static_cast<std::size_t>(axis)], pixelsOf(view, corners), true, opacity, false});
  }
}

void GizmoLayout::addMiddle(const ViewProjection& view, const GizmoFrame& frame) {
  const double radius = kMiddleRadius * view.metresPerPixel(frame.pivot);
  figures_.push_back(
      {GizmoGrip::MoveFree,
       arc(view, frame.pivot, radius * view.right(), radius * view.up(), 0.0, 2.0 * std::numbers::pi), true,
       1.0, false});
}

void GizmoLayout::addRings(const ViewProjection& view, const GizmoFrame& frame, int without) {
  const double radius = kRingRadius * view.metresPerPixel(frame.pivot);
  const glm::dvec3 sight = view.sightOf(frame.pivot);
  std::vector<GizmoFigure> near;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == without) continue;
    const glm::dvec3 unit = frame.axes[axis];
    const double facing = std::abs(glm::dot(unit, sight));
    // The direction in the ring's plane nearest to the viewer.
    const glm::dvec3 flat = glm::dot(unit, sight) * unit - sight;
    const glm::dvec3 first = radius * (glm::length(flat) > 1e-9 ? glm::normalize(flat) : across(unit)[0]);
    const glm::dvec3 second = glm::cross(unit, first);
    const GizmoGrip handle = kRings[static_cast<std::size_t>(axis)];
    const double farOpacity = std::max(kFarOpacity, ramp(facing, kRound, kQuiteRound));
    figures_.push_back({handle,
                        arc(view, frame.pivot, first, second, 0.5 * std::numbers::pi, 1.5 * std::numbers::pi),
                        false, farOpacity, facing < kQuiteRound});
    near.push_back({handle,
                    arc(view, frame.pivot, first, second, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi),
                    false, 1.0, false});
  }
  std::ranges::move(near, std::back_inserter(figures_));
}

void GizmoLayout::addViewRing(const ViewProjection& view, const GizmoFrame& frame) {
  const double radius = kViewRingRadius * view.metresPerPixel(frame.pivot);
  figures_.push_back(
      {GizmoGrip::TurnView,
       arc(view, frame.pivot, radius * view.right(), radius * view.up(), 0.0, 2.0 * std::numbers::pi), false,
       1.0, false});
}

bool GizmoLayout::has(GizmoGrip handle) const noexcept {
  return std::ranges::any_of(figures_, [handle](const GizmoFigure& f) { return f.handle == handle; });
}

GizmoGrip GizmoLayout::pick(const glm::dvec2& pixel) const noexcept {
  GizmoGrip nearest = GizmoGrip::None;
  double least = kGrabDistance;
  // What is drawn last is on top.
  for (const GizmoFigure& figure : std::views::reverse(figures_)) {
    if (figure.isFarSide || figure.opacity < kMinGrabbed) continue;
    const double distance = distanceToLine(figure.points, pixel);
    const bool isOnIt = figure.isArea ? isInside(figure.points, pixel) : distance < kOnLine;
    if (isOnIt) return figure.handle;
    // Arrows come before the surroundings of squares.
    if (isPlane(figure.handle) || !(distance < least)) continue;
    least = distance;
    nearest = figure.handle;
  }
  return nearest;
}

GizmoGuide gizmoGuide(const ViewProjection& view, const GizmoDrag& drag, const glm::dvec3& shift,
                      double angle) {
  const glm::dvec3& pivot = drag.frame().pivot;
  const double scale = view.metresPerPixel(pivot);
  GizmoGuide guide;
  if (isRing(drag.handle())) {
    const double radius = scale * (drag.handle() == GizmoGrip::TurnView ? GizmoLayout::kViewRingRadius
                                                                        : GizmoLayout::kRingRadius);
    const glm::dvec3 first = radius * drag.grabbedArm(), second = glm::cross(drag.turnAxis(), first);
    guide.sector = arc(view, pivot, first, second, 0.0,
                       std::clamp(angle, -2.0 * std::numbers::pi, 2.0 * std::numbers::pi));
    if (const auto middle = view.pixelOf(pivot)) guide.sector.push_back(*middle);
    return guide;
  }
  guide.way = pixelsOf(view, std::array{pivot, pivot + shift});
  if (!isArrow(drag.handle())) return guide;
  const glm::dvec3 axis = drag.turnAxis();
  // Far out of the view on both sides, but not past the eye.
  for (double reach = kGuideReach; reach > 1.0 && guide.line.size() != 2; reach *= 0.5)
    guide.line = pixelsOf(view, std::array{pivot - scale * reach * axis, pivot + scale * reach * axis});
  return guide;
}

double distanceToLine(std::span<const glm::dvec2> line, const glm::dvec2& point) noexcept {
  if (line.empty()) return std::numeric_limits<double>::infinity();
  double least = glm::distance(line[0], point);
  for (std::size_t i = 1; i < line.size(); ++i)
    least = std::min(least, distanceToSegment(line[i - 1], line[i], point));
  return least;
}

bool isInside(std::span<const glm::dvec2> polygon, const glm::dvec2& point) noexcept {
  bool inside = false;
  for (std::size_t i = 0, last = polygon.size() - 1; i < polygon.size(); last = i++) {
    const glm::dvec2 &a = polygon[i], &b = polygon[last];
    if ((a.y > point.y) == (b.y > point.y)) continue;
    if (point.x < a.x + (b.x - a.x) * (point.y - a.y) / (b.y - a.y)) inside = !inside;
  }
  return inside;
}

std::vector<glm::dvec2> convexHull(std::vector<glm::dvec2> points) {
  if (points.size() < 3) return points;
  std::ranges::sort(points, [](const glm::dvec2& a, const glm::dvec2& b) {
    return std::pair(a.x, a.y) < std::pair(b.x, b.y);
  });
  std::vector<glm::dvec2> hull;
  const auto add = [&hull](const glm::dvec2& point, std::size_t least) {
    while (hull.size() >= least + 2 && !(turn(hull[hull.size() - 2], hull.back(), point) > 0.0))
      hull.pop_back();
    hull.push_back(point);
  };
  // Along one side, then back along the other.
  for (const glm::dvec2& point : points)
    add(point, 0);
  const std::size_t turned = hull.size() - 1;
  for (auto it = points.rbegin() + 1; it != points.rend(); ++it)
    add(*it, turned);
  hull.pop_back();
  return hull;
}

}  // namespace nearfit
