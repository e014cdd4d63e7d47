#include "core/placing/cone_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "core/math/axes_across.h"
#include "core/math/finite.h"

namespace nearfit {
namespace {

/// Turn of the axis about two directions, shift of the centre along these, radius, slope.
constexpr std::size_t kConeParameters = 6;
constexpr int kMaxFits = 60;
/// Where the cone is narrower than this share of the points' extent, a point is its apex: it fixes the axis itself,
/// and has no direction away from it.
constexpr double kApex = 0.01;
/// Steps this small, as a share of the points' extent, change nothing that matters.
constexpr double kSmallStep = 1e-13;

using ConeStep = std::array<double, kConeParameters>;

/// Normal equations of a step.
struct ConeEquations {
  std::array<ConeStep, kConeParameters> matrix{};
  ConeStep right{};
  double cost = 0.0;  ///< Sum of squares.

  void add(const ConeStep& row, double residual) {
    cost += residual * residual;
    for (std::size_t i = 0; i < kConeParameters; ++i) {
      right[i] -= row[i] * residual;
      for (std::size_t j = 0; j < kConeParameters; ++j)
        matrix[i][j] += row[i] * row[j];
    }
  }
};

ConeEquations equationsOf(std::span<const glm::dvec3> points, const Cone& cone, bool isCylinder) {
  const auto [e1, e2] = axesAcross(cone.axis);
  ConeEquations equations;
  for (const glm::dvec3& p : points) {
    const double height = cone.heightOf(p);
    const glm::dvec3 away = p - cone.centre - height * cone.axis;
    const double wall = cone.radius + cone.slope * height, length = glm::length(away);
    const double bySlope = isCylinder ? 0.0 : 1.0;
    if (std::abs(wall) < kApex || !(length > 0.0)) {
      equations.add({-height, 0.0, -1.0, 0.0, 0.0, 0.0}, glm::dot(away, e1));
      equations.add({0.0, -height, 0.0, -1.0, 0.0, 0.0}, glm::dot(away, e2));
      equations.add({0.0, 0.0, 0.0, 0.0, 1.0, bySlope * height}, wall);
      continue;
    }
    const double u1 = glm::dot(away, e1) / length, u2 = glm::dot(away, e2) / length;
    const double lever = height + cone.slope * length;
    equations.add({-lever * u1, -lever * u2, -u1, -u2, -1.0, -bySlope * height}, length - wall);
  }
  return equations;
}

/// Solves the equations, damped; nullopt if they are singular.
std::optional<ConeStep> stepOf(ConeEquations equations, double damping) {
  auto& a = equations.matrix;
  ConeStep& b = equations.right;
  for (std::size_t i = 0; i < kConeParameters; ++i) {
    // A parameter that no point depends on stays as it is.
    if (!(a[i][i] > 0.0)) a[i][i] = 1.0;
    a[i][i] *= 1.0 + damping;
  }
  for (std::size_t column = 0; column < kConeParameters; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < kConeParameters; ++row) {
      if (std::abs(a[row][column]) > std::abs(a[pivot][column])) pivot = row;
    }
    if (!(std::abs(a[pivot][column]) > 0.0)) return std::nullopt;
    std::swap(a[pivot], a[column]);
    std::swap(b[pivot], b[column]);
    for (std::size_t row = column + 1; row < kConeParameters; ++row) {
      const double share = a[row][column] / a[column][column];
      for (std::size_t i = column; i < kConeParameters; ++i)
        a[row][i] -= share * a[column][i];
      b[row] -= share * b[column];
    }
  }
  for (std::size_t row = kConeParameters; row-- > 0;) {
    for (std::size_t i = row + 1; i < kConeParameters; ++i)
      b[row] -= a[row][i] * b[i];
    b[row] /= a[row][row];
    if (!std::isfinite(b[row])) return std::nullopt;
  }
  return b;
}

Cone afterStep(const Cone& cone, const ConeStep& step) {
  const auto [e1, e2] = axesAcross(cone.axis);
  Cone next = cone;
  next.axis = glm::normalize(cone.axis + step[0] * e1 + step[1] * e2);
  next.centre += step[2] * e1 + step[3] * e2;
  next.radius += step[4];
  next.slope += step[5];
  return next;
}

/// Fits points of an extent of about 1 around the origin.
Cone fitted(std::span<const glm::dvec3> points, Cone cone, bool isCylinder) {
  double damping = 1e-3;
  ConeEquations equations = equationsOf(points, cone, isCylinder);
  for (int i = 0; i < kMaxFits; ++i) {
    const std::optional<ConeStep> step = stepOf(equations, damping);
    if (!step) break;
    const Cone next = afterStep(cone, *step);
    ConeEquations better = equationsOf(points, next, isCylinder);
    const bool isBetter = better.cost <= equations.cost;
    damping = isBetter ? 0.2 * damping : 8.0 * damping;
    const double longest =
        std::abs(*std::ranges::max_element(*step, {}, [](double parameter) { return std::abs(parameter); }));
    if (isBetter) {
      cone = next;
      equations = better;
    }
    if (longest < kSmallStep || damping > 1e12) break;
  }
  return cone;
}

}  // namespace

double Cone::halfAngle() const noexcept {
  return std::atan(std::abs(slope));
}

double Cone::heightOf(const glm::dvec3& point) const noexcept {
  return glm::dot(point - centre, axis);
}

double Cone::distanceFrom(const glm::dvec3& point) const noexcept {
  const double height = heightOf(point);
  const double away = glm::length(point - centre - height * axis);
  return std::abs(away - (radius + slope * height)) / std::sqrt(1.0 + slope * slope);
}

Cone Cone::movedTo(double height) const noexcept {
  return {centre + height * axis, axis, radius + slope * height, slope};
}

std::optional<Cone> fitCone(std::span<const glm::dvec3> points, const Cone& guess, bool isCylinder) {
  if (points.size() < kConeParameters - (isCylinder ? 1 : 0)) return std::nullopt;
  glm::dvec3 mean(0.0);
  for (const glm::dvec3& p : points)
    mean += p / static_cast<double>(points.size());
  double extent = 0.0;
  for (const glm::dvec3& p : points)
    extent = std::max(extent, glm::distance(p, mean));
  if (!(extent > 0.0)) return std::nullopt;
  std::vector<glm::dvec3> scaled;
  scaled.reserve(points.size());
  for (const glm::dvec3& p : points)
    scaled.push_back((p - mean) / extent);
  Cone start = guess.movedTo(guess.heightOf(mean));
  start.centre = (start.centre - mean) / extent;
  start.radius /= extent;
  if (isCylinder) start.slope = 0.0;
  Cone cone = fitted(scaled, start, isCylinder);
  cone = cone.movedTo(cone.heightOf(glm::dvec3(0.0)));
  cone.centre = mean + extent * cone.centre;
  cone.radius *= extent;
  const bool isSound =
      isFinite(cone.centre) && isFinite(cone.axis) && std::isfinite(cone.slope) && cone.radius > 0.0;
  return isSound ? std::optional(cone) : std::nullopt;
}

}  // namespace nearfit
