#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "core/mesh/triangle_mesh.h"

namespace nearfit::bench {

/// Points on the surface of a mesh, none nearer to another than `spacing` and nowhere much farther apart,
/// each with those around it: a point shell. The same for the same mesh.
class SurfaceSamples {
 public:
  SurfaceSamples(const TriangleMesh& mesh, double spacing);

  std::span<const glm::dvec3> points() const noexcept { return points_; }
  /// Those within two and a half spacings on the same side of the surface.
  std::span<const std::uint32_t> around(std::size_t point) const noexcept {
    return std::span(around_).subspan(first_[point], first_[point + 1] - first_[point]);
  }

  /// Calls visit(point) for each of the points that may be within reach: a tree of balls is gone down, and
  /// isNear(centre, radius) asked of each.
  template <class IsNear, class Visit>
  void forNear(IsNear&& isNear, Visit&& visit) const {
    visitBall(0, isNear, visit);
  }

  std::size_t byteSize() const noexcept;

 private:
  struct Ball {
    glm::dvec3 centre;
    double radius;
    std::uint32_t first, count;  ///< Points, which are in the order of the tree.
    std::uint32_t child;         ///< The first of two beside each other; 0: none.
  };
  struct Candidate {
    glm::dvec3 point, normal;
  };

  template <class IsNear, class Visit>
  void visitBall(std::uint32_t index, IsNear& isNear, Visit& visit) const {
    const Ball& ball = balls_[index];
    if (!isNear(ball.centre, ball.radius)) return;
    if (ball.child == 0) {
      for (std::uint32_t i = ball.first; i < ball.first + ball.count; ++i)
        visit(i);
      return;
    }
    visitBall(ball.child, isNear, visit);
    visitBall(ball.child + 1, isNear, visit);
  }
  static std::vector<Candidate> candidatesOn(const TriangleMesh& mesh, double spacing);
  void build(std::uint32_t index, std::span<Candidate> all);
  void findAround(std::span<const Candidate> all, double reach);

  std::vector<glm::dvec3> points_;
  std::vector<std::uint32_t> first_, around_;
  std::vector<Ball> balls_;
};

}  // namespace nearfit::bench
