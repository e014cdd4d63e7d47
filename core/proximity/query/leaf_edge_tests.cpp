#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "core/math/tolerances.h"
#include "core/proximity/query/leaf_tests.h"

namespace nearfit {

bool LeafTests::edgeEdge(std::uint32_t a, std::uint32_t b, Minimum& out) const noexcept {
  const Edge ea = edgeOf(scene_.tree, a), partEdge = edgeOf(part_.tree, b);
  const Edge eb{sceneFromPart_.applyToPoint(partEdge.start), sceneFromPart_.applyToVector(partEdge.along),
                partEdge.length};
  const glm::dvec3 across = glm::cross(ea.along, eb.along);
  const double sine = glm::length(across);
  if (sine <= kFlatTolerance) {
    const Overlap overlap = overlapOf(ea, eb);
    if (sine <= kAngularTolerance || isFlat(sine, overlap)) return parallelEdges(a, b, ea, eb, overlap, out);
  }

  const glm::dvec3 w = eb.start - ea.start;
  const double s = glm::dot(glm::cross(w, eb.along), across) / (sine * sine);
  if (sine < kNearlyParallel) {
    return nearlyParallelEdges(a, b, ea, eb, s, sine, out);
  }
  glm::dvec3 direction = across / sine;
  double distance = glm::dot(w, direction);
  if (distance < 0.0) {
    direction = -direction;
    distance = -distance;
  }
  if (!(distance > 0.0) || distance > mostDistance_) return false;
  const double slack = lengthSlack(distance);
  if (s < -slack || s > ea.length + slack) return false;
  const double t = glm::dot(glm::cross(w, ea.along), across) / (sine * sine);
  if (t < -slack || t > eb.length + slack) return false;
  if (!isPolarOfEdge(scene_.tree, a, ea, direction, angularSlackBase_)) return false;
  const glm::dvec3 toScene = partFromScene_.applyToVector(-direction);
  if (!isPolarOfEdge(part_.tree, b, partEdge, toScene, angularSlackBase_)) return false;
  const glm::dvec3 p = ea.start + s * ea.along;
  accept(scene_, p, p + distance * direction, direction, distance, out);
  const double error = 2.0 * margins_.pointError() / sine;
  return settleCrossing(a, b, ea, eb,
                        {s, t, sine, angularErrorOfCrossing(ea, eb, sine), error, partEdge, toScene}, out);
}

double LeafTests::angularErrorOfCrossing(const Edge& ea, const Edge& eb, double sine) const noexcept {
  return (LeafMargins::angularErrorOfEdge(scene_.tree, ea.length) +
          LeafMargins::angularErrorOfEdge(part_.tree, eb.length)) /
         sine;
}

bool LeafTests::settleCrossing(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& eb,
                               const Crossing& c, Minimum& out) const noexcept {
  const bool isWidened = widenAtEnd(ea, eb, c.s, c.sine, out);
  const auto isClear = [&] {
    // An error of either edge, or of their common perpendicular, moves the crossing by that over their angle.
    const double place = (2.0 * margins_.pointError() + c.turn * out.lmd.distance) / c.sine;
    return !isWidened && LeafMargins::isClearAlong(c.s, ea.length, place) &&
           LeafMargins::isClearAlong(c.t, eb.length, place) &&
           areClearOfEdges(a, b, ea, c.partEdge, out.lmd.direction, c.toScene, c.turn);
  };
  return settle([&c] { return c.error; }, isClear, out);
}

bool LeafTests::widenAtEnd(const Edge& ea, const Edge& eb, double s, double sine,
                           Minimum& out) const noexcept {
  // Number of roundings that a vertex's test of directions allows.
  constexpr double kSlackOfVertex = 4.0;
  const double reach = kSlackOfVertex * pointRounding_ / (sine * sine);
  if (reach <= lengthTolerance_) return false;
  const Overlap overlap = overlapOf(ea, eb);
  const double from = std::max(overlap.from, s - reach), to = std::min(overlap.to, s + reach);
  if (to <= from || (from == s - reach && to == s + reach)) return false;
  setSegment(ea.start + from * ea.along, ea.start + to * ea.along, out);
  out.radius = out.weight;
  return true;
}

bool LeafTests::nearlyParallelEdges(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& eb,
                                    double s, double sine, Minimum& out) const noexcept {
  // The place of the minimum along the edges is known only to a rounding over their angle; the vector between
  // the two points there hardly depends on it.
  const glm::dvec3 p = ea.start + s * ea.along;
  const double t = glm::dot(p - eb.start, eb.along);
  const glm::dvec3 d = eb.start + t * eb.along - p;
  const double distance = glm::length(d);
  if (!(distance > 0.0) || distance > mostDistance_) return false;
  const double slack = lengthSlack(distance);
  if (s < -slack || s > ea.length + slack || t < -slack || t > eb.length + slack) return false;
  const glm::dvec3 direction = d / distance;
  if (!isPolarOfEdge(scene_.tree, a, ea, direction, angularSlack(distance))) return false;
  const Edge partEdge = edgeOf(part_.tree, b);
  const glm::dvec3 toScene = partFromScene_.applyToVector(-direction);
  if (!isPolarOfEdge(part_.tree, b, partEdge, toScene, angularSlack(distance))) return false;
  accept(scene_, p, p + d, direction, distance, out);
  // Adds the errors of both points, and of the place along the edges, which moves one off the other edge.
  const double turn = 3.0 * margins_.angularErrorOfPoints(distance), error = 6.0 * margins_.pointError();
  return settleCrossing(a, b, ea, eb, {s, t, sine, turn, error, partEdge, toScene}, out);
}

LeafTests::Overlap LeafTests::overlapOf(const Edge& a, const Edge& b) noexcept {
  const double s0 = glm::dot(b.start - a.start, a.along), s1 = s0 + b.length * glm::dot(b.along, a.along);
  Overlap overlap{std::max(0.0, std::min(s0, s1)), std::min(a.length, std::max(s0, s1)), {}, {}};
  overlap.onA = a.start + 0.5 * (overlap.from + overlap.to) * a.along;
  overlap.onB = b.start + glm::dot(overlap.onA - b.start, b.along) * b.along;
  return overlap;
}

double LeafTests::leastDistance(const Edge& a, const Edge& b, const Overlap& overlap) noexcept {
  // Change of the vector from a to b per unit length along a.
  const glm::dvec3 change = glm::dot(a.along, b.along) * b.along - a.along;
  const glm::dvec3 middle = overlap.onB - overlap.onA;
  const double half = 0.5 * (overlap.to - overlap.from), square = glm::dot(change, change);
  const double s = square > 0.0 ? std::clamp(-glm::dot(middle, change) / square, -half, half) : 0.0;
  return glm::length(middle + s * change);
}

bool LeafTests::isFlat(double sine, const Overlap& overlap) noexcept {
  // When closer than this, edges that are not quite parallel face each other in directions that vary along
  // them; then the place where they come nearest matters.
  return 0.5 * sine * (overlap.to - overlap.from) <=
         kRegionDirection * glm::distance(overlap.onA, overlap.onB);
}

bool LeafTests::parallelEdges(std::uint32_t a, std::uint32_t b, const Edge& ea, const Edge& eb,
                              const Overlap& overlap, Minimum& out) const noexcept {
  // Vertex tests find the minima of edges that only face each other at their ends.
  if (!(overlap.to - overlap.from > lengthTolerance_)) return false;
  const glm::dvec3 d = overlap.onB - overlap.onA;
  const double distance = glm::length(d), least = leastDistance(ea, eb, overlap);
  if (!(distance > 0.0) || least > mostDistance_) return false;
  const glm::dvec3 direction = d / distance;
  const double angular = angularSlack(distance);
  if (!isPolarOfEdge(scene_.tree, a, ea, direction, angular)) return false;
  const Edge partEdge = edgeOf(part_.tree, b);
  const glm::dvec3 toScene = partFromScene_.applyToVector(-direction);
  if (!isPolarOfEdge(part_.tree, b, partEdge, toScene, angular)) return false;
  accept(scene_, overlap.onA, overlap.onB, direction, distance, out);
  setSegment(ea.start + overlap.from * ea.along, ea.start + overlap.to * ea.along, out);
  out.least = least;
  const auto error = [this] { return 2.0 * margins_.pointError(); };
  const auto isClear = [&] {
    return out.weight > 2.0 * error() &&
           areClearOfEdges(a, b, ea, partEdge, direction, toScene, margins_.angularErrorOfPoints(distance));
  };
  return settle(error, isClear, out);
}

void LeafTests::setSegment(const glm::dvec3& from, const glm::dvec3& to, Minimum& out) noexcept {
  out.dimension = 1;
  out.weight = glm::distance(from, to);
  out.cornerCount = 2;
  out.corners[0] = from;
  out.corners[1] = to;
  out.radius = 0.5 * out.weight;
}

}  // namespace nearfit
