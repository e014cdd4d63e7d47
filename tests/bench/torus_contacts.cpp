#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "tests/bench/analytic_contacts.h"

namespace nearfit::bench {
namespace {

using std::numbers::pi;

/// Steps of each angle in the search for minima: they lie far apart beside that, where they are isolated.
constexpr int kGrid = 96;
constexpr int kNewtonSteps = 60;
/// Angles that differ by less are of one minimum [rad].
constexpr double kSameAngle = 1e-6;

struct Circle {
  glm::dvec3 centre, u, v;  ///< centre + cos u + sin v.

  explicit Circle(const Torus& torus) : centre(torus.centre) {
    const glm::dvec3 aside = std::abs(torus.axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    u = torus.majorRadius * glm::normalize(glm::cross(torus.axis, aside));
    v = glm::cross(torus.axis, u);
  }
  glm::dvec3 at(double angle) const { return centre + outward(angle); }
  glm::dvec3 outward(double angle) const { return std::cos(angle) * u + std::sin(angle) * v; }
  glm::dvec3 along(double angle) const { return std::cos(angle) * v - std::sin(angle) * u; }
};

/// Half the squared distance of two circles' points as a function of their angles, with its derivatives.
struct Expansion {
  double value;
  glm::dvec2 gradient;
  glm::dmat2 hessian;
};

Expansion expansionAt(const Circle& a, const Circle& b, const glm::dvec2& angles) {
  const glm::dvec3 d = b.at(angles.y) - a.at(angles.x), da = a.along(angles.x), db = b.along(angles.y);
  Expansion e{0.5 * glm::dot(d, d), {-glm::dot(d, da), glm::dot(d, db)}, glm::dmat2(0.0)};
  e.hessian[0][0] = glm::dot(da, da) + glm::dot(d, a.outward(angles.x));
  e.hessian[1][1] = glm::dot(db, db) - glm::dot(d, b.outward(angles.y));
  e.hessian[0][1] = e.hessian[1][0] = -glm::dot(da, db);
  return e;
}

/// Newton's method, held to descent: steps are shortened while they climb, and where the function does not
/// bulge downwards they go against the gradient.
glm::dvec2 descend(const Circle& a, const Circle& b, glm::dvec2 angles) {
  for (int i = 0; i < kNewtonSteps; ++i) {
    const Expansion e = expansionAt(a, b, angles);
    const bool isBowl = e.hessian[0][0] > 0.0 && glm::determinant(e.hessian) > 0.0;
    glm::dvec2 step = isBowl ? -(glm::inverse(e.hessian) * e.gradient)
                             : -e.gradient / (std::abs(e.hessian[0][0]) + std::abs(e.hessian[1][1]) +
                                              std::abs(e.hessian[0][1]));
    // Half the digits are all that values can tell of a minimum; the last steps are the gradient's alone.
    while (glm::length(step) > kSameAngle && expansionAt(a, b, angles + step).value > e.value)
      step *= 0.5;
    angles += step;
  }
  return angles;
}

bool isSame(const glm::dvec2& a, const glm::dvec2& b) {
  return std::abs(std::remainder(a.x - b.x, 2.0 * pi)) + std::abs(std::remainder(a.y - b.y, 2.0 * pi)) <
         kSameAngle;
}

/// Least among its eight neighbours.
std::vector<glm::dvec2> gridMinima(const Circle& a, const Circle& b) {
  std::array<std::array<double, kGrid>, kGrid> squared{};
  const auto angle = [](int i) { return 2.0 * pi * i / kGrid; };
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      const glm::dvec3 d = b.at(angle(j)) - a.at(angle(i));
      squared[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = glm::dot(d, d);
    }
  }
  const auto at = [&](int i, int j) {
    return squared[static_cast<std::size_t>((i + kGrid) % kGrid)]
                  [static_cast<std::size_t>((j + kGrid) % kGrid)];
  };
  std::vector<glm::dvec2> minima;
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      bool isLeast = true;
      for (int di = -1; di <= 1 && isLeast; ++di) {
        for (int dj = -1; dj <= 1 && isLeast; ++dj)
          isLeast = at(i, j) <= at(i + di, j + dj);
      }
      if (isLeast) minima.emplace_back(angle(i), angle(j));
    }
  }
  return minima;
}

}  // namespace

std::vector<TrueContact> torusTorus(const Torus& scene, const Torus& part) {
  const Circle a(scene), b(part);
  std::vector<glm::dvec2> found;
  std::vector<TrueContact> contacts;
  for (const glm::dvec2& start : gridMinima(a, b)) {
    const glm::dvec2 angles = descend(a, b, start);
    const Expansion e = expansionAt(a, b, angles);
    if (!(e.hessian[0][0] > 0.0 && glm::determinant(e.hessian) > 0.0)) continue;
    if (std::any_of(found.begin(), found.end(), [&](const glm::dvec2& f) { return isSame(f, angles); }))
      continue;
    found.push_back(angles);
    TrueContact& contact = contacts.emplace_back(
        sphereSphere({a.at(angles.x), scene.minorRadius}, {b.at(angles.y), part.minorRadius}));
    const glm::dvec3 u = contact.direction;
    contact.spread = contactSpread(tubeShape(scene, a.at(angles.x), u), tubeShape(part, b.at(angles.y), -u),
                                   u, contact.distance);
  }
  std::sort(contacts.begin(), contacts.end(),
            [](const TrueContact& l, const TrueContact& r) { return l.distance < r.distance; });
  return contacts;
}

}  // namespace nearfit::bench
