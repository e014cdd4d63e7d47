#include "tests/exact/triangle_separation.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace nearfit::test {
namespace {

using Corners = std::array<glm::dvec3, 3>;

/// The widest gap so far.
class Gap {
 public:
  Gap(const Corners& a, const Corners& b, double most) : a_(a), b_(b), most_(most) {}

  double width() const { return width_; }
  bool isEnough() const { return width_ >= most_; }

  /// Of a slab square to a direction, either way round.
  void tryAlong(const glm::dvec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 0.0) || !std::isfinite(length)) return;
    const glm::dvec3 unit = direction / length;
    double lowA = INFINITY, highA = -INFINITY, lowB = INFINITY, highB = -INFINITY;
    // From a corner, that far coordinates cost no digits.
    for (const glm::dvec3& p : a_) {
      const double at = glm::dot(unit, p - a_[0]);
      lowA = std::min(lowA, at);
      highA = std::max(highA, at);
    }
    for (const glm::dvec3& p : b_) {
      const double at = glm::dot(unit, p - a_[0]);
      lowB = std::min(lowB, at);
      highB = std::max(highB, at);
    }
    width_ = std::max({width_, lowB - highA, lowA - highB});
  }

 private:
  const Corners &a_, &b_;
  double most_;
  double width_ = 0.0;
};

glm::dvec3 edge(const Corners& t, std::size_t i) {
  return t[(i + 1) % 3] - t[i];
}

/// Square to an edge, from it to a point.
glm::dvec3 fromEdge(const Corners& t, std::size_t i, const glm::dvec3& point) {
  const glm::dvec3 along = edge(t, i), way = point - t[i];
  const double squared = glm::dot(along, along);
  return squared > 0.0 ? way - along * (glm::dot(along, way) / squared) : way;
}

}  // namespace

double separation(const Corners& a, const Corners& b, double most) {
  Gap gap(a, b, most);
  gap.tryAlong(glm::cross(edge(a, 0), edge(a, 1)));
  gap.tryAlong(glm::cross(edge(b, 0), edge(b, 1)));
  for (std::size_t i = 0; i < 3 && !gap.isEnough(); ++i) {
    for (std::size_t j = 0; j < 3; ++j)
      gap.tryAlong(glm::cross(edge(a, i), edge(b, j)));
  }
  for (std::size_t i = 0; i < 3 && !gap.isEnough(); ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      gap.tryAlong(a[i] - b[j]);
      gap.tryAlong(fromEdge(a, i, b[j]));
      gap.tryAlong(fromEdge(b, j, a[i]));
    }
  }
  return gap.width();
}

}  // namespace nearfit::test
