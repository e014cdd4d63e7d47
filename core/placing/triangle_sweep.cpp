#include "core/placing/triangle_sweep.h"

#include <algorithm>
#include <array>
#include <limits>

#include <glm/geometric.hpp>

#include "core/placing/sweep_stretch.h"

namespace nearfit {
namespace {

/// Edges nearer to parallel than this have no reliable common normal [rad].
constexpr double kParallel = 1e-12;

struct Shadow {
  double lower, upper;
};
Shadow shadowOf(const TriangleCorners& corners, const glm::dvec3& axis) noexcept {
  const double a = glm::dot(corners[0], axis), b = glm::dot(corners[1], axis), c = glm::dot(corners[2], axis);
  return {std::min({a, b, c}), std::max({a, b, c})};
}

struct Edges {
  std::array<glm::dvec3, 3> edge;
  glm::dvec3 normal;  ///< Not unit.
};
Edges edgesOf(const TriangleCorners& t) noexcept {
  return {{t[1] - t[0], t[2] - t[1], t[0] - t[2]}, glm::cross(t[1] - t[0], t[2] - t[0])};
}

class Sweep {
 public:
  Sweep(const TriangleCorners& fixed, const TriangleCorners& moving, const glm::dvec3& direction,
        double within) noexcept
      : fixed_(fixed), moving_(moving), direction_(direction) {
    stretch_.to = within;
  }

  /// @param longest  Length that the axis would have if its factors were perpendicular.
  /// @return False once the triangles can never touch.
  bool look(const glm::dvec3& axis, double longest) noexcept {
    const double length = glm::length(axis);
    if (!(length > kParallel * longest)) return true;
    const glm::dvec3 unit = axis / length;
    const Shadow a = shadowOf(fixed_, unit), b = shadowOf(moving_, unit);
    const double speed = glm::dot(direction_, unit);
    if (stretch_.cut(b.lower - a.upper, b.upper - a.lower, speed)) normal_ = speed < 0.0 ? unit : -unit;
    return !stretch_.isEmpty();
  }

  SweepHit hit() const noexcept { return {stretch_.from, normal_}; }

 private:
  const TriangleCorners &fixed_, &moving_;
  glm::dvec3 direction_;
  SweepStretch stretch_;
  glm::dvec3 normal_{0.0};
};

bool lookAll(Sweep& sweep, const Edges& a, const Edges& b) noexcept {
  for (const Edges* t : {&a, &b}) {
    const double longest =
        std::max({glm::length(t->edge[0]), glm::length(t->edge[1]), glm::length(t->edge[2])});
    if (!sweep.look(t->normal, longest * longest)) return false;
    for (const glm::dvec3& edge : t->edge) {
      if (!sweep.look(glm::cross(t->normal, edge), glm::length(t->normal) * glm::length(edge))) return false;
    }
  }
  for (const glm::dvec3& e : a.edge) {
    for (const glm::dvec3& f : b.edge) {
      if (!sweep.look(glm::cross(e, f), glm::length(e) * glm::length(f))) return false;
    }
  }
  return true;
}

}  // namespace

SweepHit sweepTriangles(const TriangleCorners& fixed, const TriangleCorners& moving,
                        const glm::dvec3& direction, double within) noexcept {
  Sweep sweep(fixed, moving, direction, within);
  if (lookAll(sweep, edgesOf(fixed), edgesOf(moving))) return sweep.hit();
  return {std::numeric_limits<double>::infinity(), glm::dvec3(0.0)};
}

}  // namespace nearfit
