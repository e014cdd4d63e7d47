#include "core/placing/surface_pairs.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace nearfit {
namespace {

bool hasOwnAxis(const ExactSurface& surface) noexcept {
  return surface.kind == SurfaceKind::Cylinder || surface.kind == SurfaceKind::Cone ||
         surface.kind == SurfaceKind::Torus;
}

bool areParallel(const glm::dvec3& a, const glm::dvec3& b) noexcept {
  return glm::length(glm::cross(a, b)) <= kSameDirection;
}

struct AxisLine {
  glm::dvec3 point, direction;  ///< [m]; unit.

  double heightOf(const glm::dvec3& p) const noexcept { return glm::dot(p - point, direction); }
  glm::dvec3 foot(const glm::dvec3& p) const noexcept { return point + heightOf(p) * direction; }
  /// Distance from the axis, and height along it.
  glm::dvec2 meridianOf(const glm::dvec3& p) const noexcept {
    return {glm::distance(p, foot(p)), heightOf(p)};
  }
};

AxisLine axisLineOf(const ExactSurface& surface) noexcept {
  return {surface.point, surface.direction};
}

/// Two axes are one around a point. Their own points may be far away, as the apex of a slender cone.
bool areOneAxis(const AxisLine& a, const AxisLine& b, const glm::dvec3& near, double slack) noexcept {
  return areParallel(a.direction, b.direction) && glm::distance(a.foot(near), b.foot(near)) <= slack;
}

/// The axis that both surfaces are of revolution about.
std::optional<AxisLine> commonAxis(const ExactSurface& a, const ExactSurface& b, const glm::dvec3& near,
                                   double slack) noexcept {
  if (!hasOwnAxis(a) && hasOwnAxis(b)) return commonAxis(b, a, near, slack);
  const bool isBall = b.kind == SurfaceKind::Sphere, isFlat = b.kind == SurfaceKind::Plane;
  if (hasOwnAxis(a)) {
    const AxisLine axis = axisLineOf(a);
    const bool fits = hasOwnAxis(b) ? areOneAxis(axis, axisLineOf(b), near, slack)
                      : isBall      ? glm::distance(axis.foot(b.point), b.point) <= slack
                                    : isFlat && areParallel(axis.direction, b.direction);
    return fits ? std::optional(axis) : std::nullopt;
  }
  if (a.kind == SurfaceKind::Plane && isBall) return AxisLine{b.point, a.direction};
  if (a.kind != SurfaceKind::Sphere) return std::nullopt;
  if (isFlat) return AxisLine{a.point, b.direction};
  const double apart = glm::distance(a.point, b.point);
  if (!isBall || !(apart > slack)) return std::nullopt;
  return AxisLine{a.point, (b.point - a.point) / apart};
}

/// The line or arc that a surface of revolution has in the half plane of distance from the axis and height along it.
struct Meridian {
  glm::dvec2 point;           ///< On the line; centre of an arc [m].
  glm::dvec2 direction{0.0};  ///< Along the line, unit; zero for an arc.
  double radius = 0.0;        ///< For an arc; else 0 [m].

  bool isArc() const noexcept { return radius > 0.0; }
};

Meridian meridianOf(const ExactSurface& surface, const AxisLine& axis) noexcept {
  const double height = axis.heightOf(surface.point);
  switch (surface.kind) {
    case SurfaceKind::Cylinder:
      return {{surface.radius, 0.0}, {0.0, 1.0}};
    case SurfaceKind::Cone: {
      const double up = glm::dot(surface.direction, axis.direction) < 0.0 ? -1.0 : 1.0;
      return {{0.0, height}, {std::sin(surface.halfAngle), up * std::cos(surface.halfAngle)}};
    }
    case SurfaceKind::Sphere:
      return {{0.0, height}, {}, surface.radius};
    case SurfaceKind::Torus:
      return {{surface.radius, height}, {}, surface.minorRadius};
    default:
      return {{0.0, height}, {1.0, 0.0}};
  }
}

double cross(const glm::dvec2& a, const glm::dvec2& b) noexcept {
  return a.x * b.y - a.y * b.x;
}

std::optional<glm::dvec2> meetingOfLines(const Meridian& a, const Meridian& b) noexcept {
  const double turn = cross(a.direction, b.direction);
  if (std::abs(turn) <= kSameDirection) return std::nullopt;
  return a.point + cross(b.point - a.point, b.direction) / turn * a.direction;
}

/// The crossing of a line and an arc nearest to a point, or where they touch.
std::optional<glm::dvec2> meetingWithArc(const Meridian& line, const Meridian& arc, const glm::dvec2& near,
                                         double slack) noexcept {
  const glm::dvec2 foot = line.point + glm::dot(arc.point - line.point, line.direction) * line.direction;
  const double apart = glm::distance(foot, arc.point), inside = arc.radius - apart;
  if (inside < -slack) return std::nullopt;
  const double half = std::sqrt(std::max(0.0, inside * (arc.radius + apart)));
  // Where they touch, rounding moves the crossings by its square root.
  if (std::abs(inside) <= slack && glm::distance(foot, near) <= std::max(0.5 * half, slack)) return foot;
  const glm::dvec2 ahead = foot + half * line.direction, behind = foot - half * line.direction;
  return glm::distance(ahead, near) < glm::distance(behind, near) ? ahead : behind;
}

/// The line through the crossings of two arcs.
std::optional<Meridian> chordOf(const Meridian& a, const Meridian& b, double slack) noexcept {
  const glm::dvec2 between = b.point - a.point;
  const double apart = glm::length(between);
  if (!(apart > slack)) return std::nullopt;
  const double ahead = 0.5 * (apart + (a.radius - b.radius) * (a.radius + b.radius) / apart);
  return Meridian{a.point + ahead / apart * between, glm::dvec2(-between.y, between.x) / apart};
}

std::optional<glm::dvec2> meetingOf(const Meridian& a, const Meridian& b, const glm::dvec2& near,
                                    double slack) noexcept {
  if (!a.isArc()) return b.isArc() ? meetingWithArc(a, b, near, slack) : meetingOfLines(a, b);
  if (!b.isArc()) return meetingWithArc(b, a, near, slack);
  const std::optional<Meridian> chord = chordOf(a, b, slack);
  return chord ? meetingWithArc(*chord, a, near, slack) : std::nullopt;
}

/// The point of a circle about an axis nearest to `point`, and the direction from there away from the axis.
struct OnRing {
  glm::dvec3 point, outward;
};

std::optional<OnRing> nearestOnRing(const ExactSurface& torus, const glm::dvec3& point) noexcept {
  const AxisLine axis = axisLineOf(torus);
  const glm::dvec3 aside = point - axis.foot(point);
  const double length = glm::length(aside);
  if (!(length > 0.0)) return std::nullopt;
  return OnRing{torus.point + torus.radius / length * aside, aside / length};
}

/// The point at that distance from `centre` towards `point`.
glm::dvec3 towards(const glm::dvec3& centre, const glm::dvec3& point, double distance) noexcept {
  const glm::dvec3 way = point - centre;
  const double length = glm::length(way);
  return length > 0.0 ? centre + distance / length * way : point;
}

glm::dvec3 nearestOnCone(const ExactSurface& cone, const glm::dvec3& point) noexcept {
  const AxisLine axis = axisLineOf(cone);
  const glm::dvec3 aside = point - axis.foot(point);
  const double length = glm::length(aside);
  if (!(length > 0.0)) return point;
  const glm::dvec3 along =
      std::cos(cone.halfAngle) * cone.direction + std::sin(cone.halfAngle) / length * aside;
  return cone.point + std::max(0.0, glm::dot(point - cone.point, along)) * along;
}

/// Radius of a cone at the height of a point [m].
double radiusAt(const ExactSurface& cone, const glm::dvec3& point) noexcept {
  return axisLineOf(cone).heightOf(point) * std::tan(cone.halfAngle);
}

bool areOnePlane(const ExactSurface& a, const ExactSurface& b, const glm::dvec3& near,
                 double slack) noexcept {
  const glm::dvec3 foot = nearestOnSurface(a, near);
  return areParallel(a.direction, b.direction) && glm::dot(a.direction, b.direction) > 0.0 &&
         glm::distance(foot, nearestOnSurface(b, foot)) <= slack;
}

bool areOneCone(const ExactSurface& a, const ExactSurface& b, const glm::dvec3& near, double slack) noexcept {
  return areOneAxis(axisLineOf(a), axisLineOf(b), near, slack) && glm::dot(a.direction, b.direction) > 0.0 &&
         std::abs(a.halfAngle - b.halfAngle) <= kSameDirection &&
         std::abs(radiusAt(a, near) - radiusAt(b, near)) <= slack;
}

}  // namespace

glm::dvec3 nearestOnSurface(const ExactSurface& surface, const glm::dvec3& point) noexcept {
  switch (surface.kind) {
    case SurfaceKind::Plane:
      return point - glm::dot(point - surface.point, surface.direction) * surface.direction;
    case SurfaceKind::Cylinder:
      return towards(axisLineOf(surface).foot(point), point, surface.radius);
    case SurfaceKind::Cone:
      return nearestOnCone(surface, point);
    case SurfaceKind::Sphere:
      return towards(surface.point, point, surface.radius);
    case SurfaceKind::Torus: {
      const std::optional<OnRing> ring = nearestOnRing(surface, point);
      return ring ? towards(ring->point, point, surface.minorRadius) : point;
    }
    default:
      return point;
  }
}

bool areOneSurface(const ExactSurface& a, const ExactSurface& b, const glm::dvec3& near,
                   double slack) noexcept {
  if (a.kind != b.kind) return false;
  if (a.kind == SurfaceKind::Plane) return areOnePlane(a, b, near, slack);
  if (a.kind == SurfaceKind::Other || a.isHollow != b.isHollow) return false;
  if (a.kind == SurfaceKind::Cone) return areOneCone(a, b, near, slack);
  if (std::abs(a.radius - b.radius) > slack || std::abs(a.minorRadius - b.minorRadius) > slack) return false;
  if (a.kind == SurfaceKind::Cylinder) return areOneAxis(axisLineOf(a), axisLineOf(b), near, slack);
  if (glm::distance(a.point, b.point) > slack) return false;
  return a.kind == SurfaceKind::Sphere || areParallel(a.direction, b.direction);
}

std::optional<Circle> circleBetween(const ExactSurface& a, const ExactSurface& b, const glm::dvec3& near,
                                    double slack) noexcept {
  const std::optional<AxisLine> axis = commonAxis(a, b, near, slack);
  if (!axis) return std::nullopt;
  const std::optional<glm::dvec2> at =
      meetingOf(meridianOf(a, *axis), meridianOf(b, *axis), axis->meridianOf(near), slack);
  if (!at || !(at->x > slack)) return std::nullopt;
  return Circle{axis->point + at->y * axis->direction, axis->direction, at->x};
}

std::optional<Circle> lineBetween(const ExactSurface& a, const ExactSurface& b,
                                  const glm::dvec3& near) noexcept {
  if (a.kind != SurfaceKind::Plane || b.kind != SurfaceKind::Plane) return std::nullopt;
  const glm::dvec3 along = glm::cross(a.direction, b.direction);
  const double sine = glm::length(along);
  if (sine <= kSameDirection) return std::nullopt;
  const double cosine = glm::dot(a.direction, b.direction);
  const double offA = glm::dot(a.direction, a.point - near), offB = glm::dot(b.direction, b.point - near);
  const double shareA = (offA - cosine * offB) / (sine * sine),
               shareB = (offB - cosine * offA) / (sine * sine);
  return Circle{near + shareA * a.direction + shareB * b.direction, along / sine, 0.0};
}

}  // namespace nearfit
