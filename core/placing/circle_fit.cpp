#include "core/placing/circle_fit.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat2x2.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "core/math/symmetric_eigen.h"

namespace nearfit {
namespace {

/// Points are collinear if their spread across the line is below this fraction of its length.
constexpr double kInARow = 1e-6;

glm::dvec3 meanOf(std::span<const glm::dvec3> points) {
  glm::dvec3 sum(0.0);
  for (const glm::dvec3& p : points)
    sum += p;
  return sum / static_cast<double>(points.size());
}

struct Plane {
  glm::dvec3 u, v;
};
Plane planeAcross(const glm::dvec3& axis) {
  const glm::dvec3 other = std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 u = glm::normalize(glm::cross(axis, other));
  return {u, glm::cross(axis, u)};
}

}  // namespace

double Circle::distanceFromCylinder(const glm::dvec3& point) const noexcept {
  const glm::dvec3 offset = point - centre;
  return std::abs(glm::length(offset - glm::dot(offset, axis) * axis) - radius);
}

double Circle::distanceFrom(const glm::dvec3& point) const noexcept {
  return std::hypot(distanceFromCylinder(point), glm::dot(point - centre, axis));
}

std::optional<Circle> fitCylinder(std::span<const glm::dvec3> points, const glm::dvec3& axis) {
  if (points.size() < 3) return std::nullopt;
  const glm::dvec3 mean = meanOf(points);
  const Plane plane = planeAcross(axis);
  // Fit x^2 + y^2 = a x + b y + c, relative to the mean, so that the sums of x and y vanish.
  double xx = 0.0, xy = 0.0, yy = 0.0, xs = 0.0, ys = 0.0, s = 0.0;
  for (const glm::dvec3& p : points) {
    const double x = glm::dot(p - mean, plane.u), y = glm::dot(p - mean, plane.v), square = x * x + y * y;
    xx += x * x;
    xy += x * y;
    yy += y * y;
    xs += x * square;
    ys += y * square;
    s += square;
  }
  const double determinant = xx * yy - xy * xy;
  if (!(determinant > kInARow * kInARow * (xx + yy) * (xx + yy))) return std::nullopt;
  const double a = (xs * yy - ys * xy) / determinant, b = (ys * xx - xs * xy) / determinant;
  const double c = s / static_cast<double>(points.size());
  Circle circle;
  circle.axis = axis;
  circle.centre = mean + 0.5 * a * plane.u + 0.5 * b * plane.v;
  circle.radius = std::sqrt(c + 0.25 * (a * a + b * b));
  return circle;
}

std::optional<Circle> fitCircle(std::span<const glm::dvec3> points) {
  if (points.size() < 3) return std::nullopt;
  const glm::dvec3 mean = meanOf(points);
  glm::dmat3 spread(0.0);
  for (const glm::dvec3& p : points)
    spread += glm::outerProduct(p - mean, p - mean);
  const SymmetricEigen eigen = symmetricEigen(spread);
  return fitCylinder(points, eigen.vectors[0]);
}

}  // namespace nearfit
