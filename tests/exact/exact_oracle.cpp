#include "tests/exact/exact_oracle.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <glm/geometric.hpp>

#include "tests/exact/box_index.h"
#include "tests/exact/exact_body.h"

namespace nearfit::test {
namespace {

using exact::Feature;
using exact::lengthOf;
using exact::nearest;
using exact::Number;
using exact::Point;
using exact::Vector;

/// What the engine promises to resolve, as its documentation states it.
constexpr double kDirections = 1e-10;  ///< [rad]
constexpr double kLengths = 1e-12;     ///< Of the size.
constexpr double kRounding = 1e-15;    ///< Of the size: of a coordinate.
constexpr double kFlat = 1e-6;         ///< [rad]: what is as parallel may count as parallel.

/// The two points at which the spans of a pair are nearest, and the conditions that they meet or miss.
class Candidate {
 public:
  Candidate(const Feature& a, const Feature& b, double size, double leastMargin)
      : a_(a), b_(b), size_(size), leastMargin_(leastMargin) {}

  std::optional<ExactMinimum> evaluate(double cutoff) {
    if (!findPoints()) return evaluateFlat(cutoff);
    d_ = q_ - p_;
    return checked(cutoff);
  }

  /// Two edges that cross, but so slowly that they count as parallel.
  bool mayBeFlat() const { return sineSquared_ > 0.0 && std::sqrt(sineSquared_) <= kFlat; }
  std::optional<ExactMinimum> evaluateFlat(double cutoff) {
    if (!findFlat()) return std::nullopt;
    d_ = q_ - p_;
    bringBefore();
    return checked(cutoff);
  }

 private:
  std::optional<ExactMinimum> checked(double cutoff) {
    squared_ = d_.squared_length();
    if (squared_ == 0) return std::nullopt;
    distance_ = std::sqrt(CGAL::to_double(squared_));
    if (distance_ > cutoff || !(isFlat_ || checkExtents()) || !checkSide(a_, d_) || !checkSide(b_, -d_))
      return std::nullopt;
    return ExactMinimum{{a_.kind, b_.kind},
                        nearest(p_ - CGAL::ORIGIN),
                        nearest(q_ - CGAL::ORIGIN),
                        nearest(d_) / std::sqrt(nearest(squared_)),
                        std::sqrt(nearest(squared_)),
                        margin_,
                        place_,
                        angle_,
                        sineSquared_ > 0.0 ? std::sqrt(sineSquared_) * tilt_ : tilt_,
                        !isFlat_ && !isFlatRim(a_) && !isFlatRim(b_) && hasClearSides_,
                        isFlat_};
  }

  /// Takes a condition's value in units of its tolerance in; whether the pair is still of interest.
  bool take(double value, double tolerance) {
    margin_ = std::min(margin_, value / tolerance);
    return margin_ >= leastMargin_;
  }

  /// Where faces with no common side lie flat across an edge.
  static bool isFlatRim(const Feature& f) {
    if (f.kind != 'e' || f.hasSide) return false;
    for (const exact::Tangent& t : f.tangents) {
      const Vector& first = f.tangents[0].vector;
      if (CGAL::cross_product(t.vector, first) == CGAL::NULL_VECTOR && t.vector * first < 0) return true;
    }
    return false;
  }

  Point foot(const Feature& f, const Point& x) {
    if (f.kind == 'f') {
      return x - f.span * ((x - f.corners[0]) * f.span / f.span.squared_length());
    }
    return f.corners[0] + f.span * ((x - f.corners[0]) * f.span / f.span.squared_length());
  }

  /// False where spans are parallel, or the pair of kinds has no point minima.
  bool findPoints() {
    p_ = a_.corners[0];
    q_ = b_.corners[0];
    if (a_.kind == 'v' && b_.kind == 'v') return true;
    if (a_.kind == 'v') return q_ = foot(b_, p_), true;
    if (b_.kind == 'v') return p_ = foot(a_, q_), true;
    if (a_.kind != 'e' || b_.kind != 'e') return false;
    const Vector &u = a_.span, &v = b_.span, across = CGAL::cross_product(u, v), w = q_ - p_;
    const Number sine = across.squared_length();
    sineSquared_ = CGAL::to_double(sine) / (a_.height * a_.height * b_.height * b_.height);
    if (std::sqrt(sineSquared_) <= parallelTolerance(a_, b_)) return false;
    p_ = p_ + u * (CGAL::cross_product(w, v) * across / sine);
    q_ = q_ + v * (CGAL::cross_product(w, u) * across / sine);
    return true;
  }

  double parallelTolerance(const Feature& a, const Feature& b) const {
    return kDirections + kRounding * size_ * (1.0 / a.height + 1.0 / b.height);
  }

  /// Parallel spans that are not both vertices: the points at their middles, if seen from one the other lies
  /// along its normal. Whether they overlap at all is not asked.
  bool findFlat() {
    if (a_.kind == 'v' || b_.kind == 'v') return false;
    isFlat_ = true;
    const Feature &flat = a_.kind == 'f' ? a_ : b_, &other = &flat == &a_ ? b_ : a_;
    const Vector across = flat.kind != other.kind ? Vector() : CGAL::cross_product(flat.span, other.span);
    const double sine =
        (flat.kind != other.kind ? std::abs(CGAL::to_double(flat.span * other.span)) : lengthOf(across)) /
        (lengthOf(flat.span) * lengthOf(other.span));
    if (!take(1.0 - sine / (kFlat + parallelTolerance(a_, b_)), 1.0)) return false;
    const Point middle = CGAL::midpoint(other.corners[0], other.corners.back()), on = foot(flat, middle);
    p_ = &flat == &a_ ? on : middle;
    q_ = &flat == &a_ ? middle : on;
    return true;
  }

  /// What is tilted within kFlat and ends before a face may have its middle behind it.
  void bringBefore() {
    const Feature& flat = a_.kind == 'f' ? a_ : b_;
    if (flat.kind != 'f' || !flat.hasSide) return;
    const Vector outward = &flat == &a_ ? flat.span : -flat.span;
    if (d_ * outward > 0) return;
    const double behind = lengthOf(d_);
    if (behind <= kFlat * size_) d_ = outward * Number(kFlat * size_ / lengthOf(outward));
  }

  bool checkExtents() {
    const double angular = kDirections + kRounding * size_ / distance_;
    double along = kLengths * size_ + kDirections * distance_;
    if (sineSquared_ > 0.0) {
      place_ = angular * distance_ / sineSquared_;
      angle_ = std::sqrt(sineSquared_);
      along = kLengths * size_ + place_;
    }
    return isInside(a_, p_, along) && isInside(b_, q_, along);
  }

  bool isInside(const Feature& f, const Point& x, double tolerance) {
    if (f.kind == 'e') {
      const double from = CGAL::to_double((x - f.corners[0]) * f.span) / f.height;
      const double to = CGAL::to_double((f.corners[1] - x) * f.span) / f.height;
      return take(std::min(from, to), tolerance);
    }
    if (f.kind == 'f') {
      tolerance += kRounding * size_ * distance_ / f.height;
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector inward = CGAL::cross_product(f.span, f.corners[(k + 1) % 3] - f.corners[k]);
        if (!take(CGAL::to_double((x - f.corners[k]) * inward) / lengthOf(inward), tolerance)) return false;
      }
    }
    return true;
  }

  /// The tangent cone of one side, and that `d`, which leaves it, goes outward.
  bool checkSide(const Feature& f, const Vector& d) {
    const Feature& other = &f == &a_ ? b_ : a_;
    double base = kDirections + kRounding * size_ / distance_;
    if (other.kind == 'f') base += kRounding * size_ / other.height;
    if (isFlat_) base += kFlat;
    bool isStrict = true;
    for (const exact::Tangent& t : f.tangents) {
      const double along = CGAL::to_double(d * t.vector) / (distance_ * t.length);
      isStrict = isStrict && along < 0.0;
      angle_ = std::min(angle_, -along);
      tilt_ = std::min(tilt_, -along);
      if (!take(-along, base + kRounding * size_ / t.length)) return false;
    }
    if (!f.hasSide) return true;
    if (f.kind == 'f') return d * f.span > 0;  // And along it: the other points were sought there.
    return f.kind == 'e' ? isOutsideEdge(f, d) : isOutsideVertex(f, d, isStrict);
  }

  bool isOutsideEdge(const Feature& f, const Vector& d) {
    // All directions that a convex edge's cone allows are outward, all that a reflex edge's does inward.
    if (f.convexity > 0.0) return true;
    if (!f.isFolded && glm::dot(roughly(d), f.outward) <= 0.0) return false;
    return take(f.convexity,
                kDirections + kRounding * size_ * (1.0 / f.tangents[0].length + 1.0 / f.tangents[1].length));
  }

  /// Where all edges go strictly back from d, the fan is a polygon seen along it: the material is inside
  /// where it turns to the left. Of a fan that does not cross itself the mean normal says the same.
  bool isOutsideVertex(const Feature& f, const Vector& d, bool isStrict) {
    if (isCrossed(f)) {
      // One lobe's outside is the other's inside. The mean normal, by which the definition goes, is a mean
      // over both, and so is the area, by other weights: their signs differ, and with d.
      hasClearSides_ = false;
      return true;
    }
    // Folded back on itself a sheet has two outsides.
    constexpr double kNoSide = 1e-9;
    if (!isStrict) return glm::length(f.outward) < kNoSide || glm::dot(roughly(d), f.outward) > 0.0;
    Number area = 0;
    double sum = 0.0;
    for (const auto& [a, b] : f.fan) {
      const Number piece = d * CGAL::cross_product(a, b) / ((d * a) * (d * b));
      area += piece;
      sum += std::abs(CGAL::to_double(piece));
    }
    return CGAL::to_double(area) > -kNoSide * sum;
  }

  /// Whether faces pass through each other at the vertex, beyond rounding. All of its edges are within half a
  /// turn of each other: arcs that each part the other's ends cross.
  static bool isCrossed(const Feature& f) {
    constexpr double kClear = 1e-14;
    const auto unit = [](const Vector& v) {
      return glm::dvec3(CGAL::to_double(v.x()), CGAL::to_double(v.y()), CGAL::to_double(v.z())) / lengthOf(v);
    };
    std::vector<std::array<glm::dvec3, 2>> arcs;
    for (const auto& [a, b] : f.fan)
      arcs.push_back({unit(a), unit(b)});
    const auto doesPart = [](const auto& arc, const auto& ends) {
      const glm::dvec3 n = glm::cross(arc[0], arc[1]);
      const double s = glm::dot(n, ends[0]), t = glm::dot(n, ends[1]);
      return std::min(s, t) < -kClear && std::max(s, t) > kClear;
    };
    for (std::size_t i = 0; i < arcs.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (doesPart(arcs[i], arcs[k]) && doesPart(arcs[k], arcs[i])) return true;
      }
    }
    return false;
  }

  glm::dvec3 roughly(const Vector& d) const {
    return glm::dvec3(CGAL::to_double(d.x()), CGAL::to_double(d.y()), CGAL::to_double(d.z())) / distance_;
  }

  const Feature &a_, &b_;
  const double size_, leastMargin_;
  Point p_, q_;
  Vector d_;
  Number squared_;
  double distance_ = 0.0, sineSquared_ = 0.0, place_ = 0.0;
  bool isFlat_ = false, hasClearSides_ = true;
  double angle_ = 1.0, tilt_ = 1.0;
  double margin_ = std::numeric_limits<double>::infinity();
};

std::vector<Box> boxesOf(std::span<const Feature> features) {
  std::vector<Box> boxes;
  for (const Feature& feature : features)
    boxes.push_back({feature.lower, feature.upper});
  return boxes;
}

}  // namespace

struct ExactOracle::Bodies {
  exact::Body scene, part;
  std::vector<Feature> sceneFeatures = scene.features({});
  BoxIndex sceneBoxes{boxesOf(sceneFeatures)};
};

ExactOracle::ExactOracle(const TriangleMesh& scene, const TriangleMesh& part)
    : bodies_(std::make_unique<Bodies>(Bodies{exact::Body(scene), exact::Body(part)})) {}
ExactOracle::~ExactOracle() = default;

double ExactOracle::size() const {
  return bodies_->scene.size() + bodies_->part.size();
}

std::vector<ExactMinimum> ExactOracle::minima(const RigidTransform& sceneFromPart, double cutoff,
                                              double leastMargin) const {
  std::vector<ExactMinimum> found;
  // Boxes are rounded; those of features near each other are compared to more than the margin.
  const double gap = cutoff * (1.0 + 1e-9) + 1e-9 * size();
  std::vector<std::uint32_t> near;
  for (const Feature& b : bodies_->part.features(sceneFromPart)) {
    bodies_->sceneBoxes.findMeeting({b.lower - gap, b.upper + gap}, near);
    for (const std::uint32_t i : near) {
      const Feature& a = bodies_->sceneFeatures[i];
      Candidate candidate(a, b, size(), leastMargin);
      if (const auto minimum = candidate.evaluate(cutoff)) {
        found.push_back(*minimum);
      } else if (candidate.mayBeFlat()) {
        if (const auto flat = Candidate(a, b, size(), leastMargin).evaluateFlat(cutoff))
          found.push_back(*flat);
      }
    }
  }
  return found;
}

}  // namespace nearfit::test
