#include "core/proximity/query/flat_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "core/math/plane_cross.h"
#include "core/math/tolerances.h"
#include "core/proximity/query/touching.h"

namespace nearfit {
namespace {

/// Plane perpendicular to a direction, with its own axes about a point.
class Plane {
 public:
  Plane(const glm::dvec3& origin, const glm::dvec3& normal) noexcept : origin_(origin), normal_(normal) {
    const glm::dvec3 helper = std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    x_ = glm::normalize(glm::cross(helper, normal));
    y_ = glm::cross(normal, x_);
  }
  glm::dvec2 map(const glm::dvec3& p) const noexcept {
    return {glm::dot(p - origin_, x_), glm::dot(p - origin_, y_)};
  }
  double height(const glm::dvec3& p) const noexcept { return glm::dot(p - origin_, normal_); }
  glm::dvec3 along(const glm::dvec2& v) const noexcept { return v.x * x_ + v.y * y_; }
  glm::dvec3 point(const glm::dvec2& p, double height) const noexcept {
    return origin_ + along(p) + height * normal_;
  }

 private:
  glm::dvec3 origin_, normal_, x_, y_;
};

/// A piece in a plane: a segment, or a convex polygon with its corners anticlockwise.
struct Outline {
  Outline(const Minimum& piece, const Plane& plane) noexcept : count(piece.cornerCount) {
    double area = 0.0;
    for (std::size_t i = 0; i < count; ++i)
      corners[i] = plane.map(piece.corners[i]);
    for (std::size_t i = 1; i + 1 < count; ++i)
      area += cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    if (area < 0.0) std::reverse(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(count));
  }
  std::size_t sides() const noexcept { return count == 2 ? 1 : count; }
  const glm::dvec2& from(std::size_t i) const noexcept { return corners[i]; }
  const glm::dvec2& to(std::size_t i) const noexcept { return corners[(i + 1) % count]; }

  bool contains(const glm::dvec2& p, double tolerance) const noexcept {
    if (count == 2) {
      const glm::dvec2 e = corners[1] - corners[0];
      const double s = std::clamp(glm::dot(p - corners[0], e) / glm::dot(e, e), 0.0, 1.0);
      return glm::distance(p, corners[0] + s * e) <= tolerance;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const glm::dvec2 e = to(i) - from(i);
      if (cross(e, p - from(i)) < -tolerance * glm::length(e)) return false;
    }
    return true;
  }

  std::array<glm::dvec2, Minimum::kMaxCorners> corners;
  std::size_t count;
};

/// Covered interval of a segment from a to b, as fractions of its length.
struct Interval {
  double from = 0.0, to = 1.0;
};

/// Interval of the segment from a to b inside a polygon. Along one of the polygon's sides, in its sense, the
/// segment counts as covered only if the polygon is the earlier of the two pieces.
Interval coveredByPolygon(const glm::dvec2& a, const glm::dvec2& b, const Outline& polygon, bool isEarlier,
                          double tolerance) noexcept {
  Interval covered;
  const glm::dvec2 way = b - a;
  for (std::size_t k = 0; k < polygon.count; ++k) {
    const glm::dvec2 side = polygon.to(k) - polygon.from(k);
    const double length = glm::length(side);
    if (!(length > tolerance)) continue;
    const double start = cross(side, a - polygon.from(k)) / length,
                 end = cross(side, b - polygon.from(k)) / length;
    if (std::abs(start) <= tolerance && std::abs(end) <= tolerance) {
      if (isEarlier && glm::dot(side, way) > 0.0) continue;
      return {0.0, 0.0};
    }
    if (start <= 0.0 && end <= 0.0) return {0.0, 0.0};
    if (start < 0.0) covered.from = std::max(covered.from, start / (start - end));
    if (end < 0.0) covered.to = std::min(covered.to, start / (start - end));
  }
  return covered;
}

/// Interval of the segment from a to b that runs along another segment.
Interval coveredBySegment(const glm::dvec2& a, const glm::dvec2& b, const Outline& segment,
                          double tolerance) noexcept {
  const glm::dvec2 way = b - a;
  const double length = glm::length(way);
  if (!(length > 0.0)) return {};
  const auto isOff = [&](const glm::dvec2& p) { return std::abs(cross(way, p - a)) > tolerance * length; };
  if (isOff(segment.corners[0]) || isOff(segment.corners[1])) return {0.0, 0.0};
  const auto share = [&](const glm::dvec2& p) { return glm::dot(p - a, way) / (length * length); };
  const double s = share(segment.corners[0]), t = share(segment.corners[1]);
  return {std::max(0.0, std::min(s, t)), std::min(1.0, std::max(s, t))};
}

/// Measure (length or area) of a set in the plane, and its first and second moments about the plane's origin.
struct Moments {
  double measure = 0.0;
  glm::dvec2 first{0.0};
  double xx = 0.0, xy = 0.0, yy = 0.0;

  void addSegment(const glm::dvec2& a, const glm::dvec2& b) noexcept {
    const double length = glm::distance(a, b);
    measure += length;
    first += 0.5 * length * (a + b);
    xx += length / 3.0 * (a.x * a.x + a.x * b.x + b.x * b.x);
    yy += length / 3.0 * (a.y * a.y + a.y * b.y + b.y * b.y);
    xy += length / 6.0 * (2.0 * a.x * a.y + a.x * b.y + b.x * a.y + 2.0 * b.x * b.y);
  }
  /// Adds a section of the set's outline, anticlockwise, by Green's theorem.
  void addBoundary(const glm::dvec2& a, const glm::dvec2& b) noexcept {
    const double c = cross(a, b);
    measure += c / 2.0;
    first += c / 6.0 * (a + b);
    xx += c / 12.0 * (a.x * a.x + a.x * b.x + b.x * b.x);
    yy += c / 12.0 * (a.y * a.y + a.y * b.y + b.y * b.y);
    xy += c / 24.0 * (2.0 * a.x * a.y + a.x * b.y + b.x * a.y + 2.0 * b.x * b.y);
  }
};

/// A union measures no less than its largest piece; half of that allows for rounding.
constexpr double kMinFlatShare = 0.5;

class RegionUnion {
 public:
  /// @param dimension  Of the pieces that count; at least one piece has it.
  RegionUnion(std::span<const Minimum> minima, std::span<const std::uint32_t> group,
              const RegionNeighbours& neighbours, double tolerance, std::uint8_t dimension) noexcept
      : minima_(minima),
        group_(group),
        neighbours_(neighbours),
        tolerance_(tolerance),
        dimension_(dimension),
        largest_(largestPiece()),
        direction_(meanDirection()),
        plane_(largest_.lmd.scenePoint, direction_) {}

  /// Moments of the union of the pieces.
  Moments moments() const noexcept {
    Moments sum;
    for (const std::uint32_t i : group_) {
      if (isPiece(minima_[i])) addPiece(i, sum);
    }
    // If slivers cover each other, rounding may leave nothing, or less.
    if (!(sum.measure > kMinFlatShare * largest_.weight)) {
      sum = {};
      addOutline(sum);
    }
    return sum;
  }

  /// Returns whether the pieces are faces whose overlap is only a strip, no wider than the tolerance for
  /// parallel edges allows, while edges of the region lead beyond the ends of the strip. Two edges that are
  /// parallel to kFlatTolerance diverge by up to that times their length. The overlap of two faces shifts by up
  /// to that times their distance when it is seen along the normal of the other face. So such edges may face
  /// each other over their full length, while the faces beside them overlap near one end, or nowhere: which of
  /// the two is below the tolerance. A representative of the strip alone would leave out most of the region.
  /// @param area  Of the union of the pieces [m^2].
  bool isStripOfLongerEdges(double area) const noexcept {
    if (dimension_ != 2) return false;
    const double distance = largest_.lmd.distance;
    const auto isStrip = [&](double reach, double length) {
      return area <= kFlatTolerance * (reach + distance) * length;
    };
    // An upper bound of both lengths rules out nearly all regions, at the cost of one pass.
    const double most = 2.0 * radius();
    if (!isStrip(most, most)) return false;
    const glm::dvec3 start = farthest(2, largest_.lmd.scenePoint), end = farthest(2, start);
    const double length = glm::distance(start, end);
    const double reach =
        std::max(glm::distance(start, farthest(1, start)), glm::distance(end, farthest(1, end)));
    return length < (1.0 - kFlatTolerance) * reach && isStrip(reach, length);
  }

  Lmd unite(const Moments& moments) const noexcept {
    bool isMarginal = true;
    double weight = 0.0, height = 0.0, distance = 0.0, least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : group_) {
      const Minimum& piece = minima_[i];
      least = std::min(least, piece.least);
      if (!isPiece(piece)) continue;
      isMarginal = isMarginal && piece.lmd.isMarginal;
      weight += piece.weight;
      height += piece.weight * plane_.height(piece.lmd.scenePoint);
      distance += piece.weight * piece.lmd.distance;
    }
    Lmd lmd = largest_.lmd;
    lmd.isMarginal = isMarginal;
    if (!(moments.measure > 0.0)) return lmd;
    const glm::dvec2 centroid = moments.first / moments.measure;
    // Exact tests may see a corner of a tilted region beyond contact.
    lmd.distance = std::max(least, std::numeric_limits<double>::min());
    lmd.direction = direction_;
    lmd.scenePoint = plane_.point(centroid, height / weight);
    lmd.partPoint = lmd.scenePoint + distance / weight * lmd.direction;
    setExtent(moments, centroid, lmd.extent);
    return lmd;
  }

 private:
  const Minimum& largestPiece() const noexcept {
    const auto weight = [&](std::uint32_t i) { return isPiece(minima_[i]) ? minima_[i].weight : -1.0; };
    return minima_[*std::max_element(group_.begin(), group_.end(), [&](std::uint32_t a, std::uint32_t b) {
      return weight(a) < weight(b);
    })];
  }
  bool isPiece(const Minimum& m) const noexcept { return m.dimension == dimension_; }
  /// Radius of a sphere about the largest piece's centroid that contains all pieces, of faces and edges [m].
  double radius() const noexcept {
    double most = 0.0;
    for (const std::uint32_t i : group_) {
      const Minimum& m = minima_[i];
      if (m.dimension == 0) continue;
      most = std::max(most, glm::distance(m.lmd.scenePoint, largest_.lmd.scenePoint) + m.radius);
    }
    return most;
  }
  /// Returns the corner farthest from a point among the pieces of a dimension, or the point if there are none.
  glm::dvec3 farthest(std::uint8_t dimension, const glm::dvec3& from) const noexcept {
    glm::dvec3 corner = from;
    for (const std::uint32_t i : group_) {
      const Minimum& m = minima_[i];
      if (m.dimension != dimension) continue;
      for (std::size_t k = 0; k < m.cornerCount; ++k) {
        if (glm::distance(m.corners[k], from) > glm::distance(corner, from)) corner = m.corners[k];
      }
    }
    return corner;
  }
  glm::dvec3 meanDirection() const noexcept {
    glm::dvec3 sum(0.0);
    for (const std::uint32_t i : group_) {
      if (isPiece(minima_[i])) sum += minima_[i].weight * minima_[i].lmd.direction;
    }
    return glm::normalize(sum);
  }

  /// Adds the whole outline of the largest piece.
  void addOutline(Moments& moments) const noexcept {
    const Outline outline(largest_, plane_);
    for (std::size_t k = 0; k < outline.sides(); ++k) {
      dimension_ == 2 ? moments.addBoundary(outline.from(k), outline.to(k))
                      : moments.addSegment(outline.from(k), outline.to(k));
    }
  }

  void addPiece(std::uint32_t at, Moments& moments) const noexcept {
    const Minimum& piece = minima_[at];
    const Outline outline(piece, plane_);
    const auto add = [&](const glm::dvec2& a, const glm::dvec2& b) {
      piece.dimension == 2 ? moments.addBoundary(a, b) : moments.addSegment(a, b);
    };
    for (std::size_t k = 0; k < outline.sides(); ++k) {
      if (piece.isOverlapping) {
        addUncovered(at, outline.from(k), outline.to(k), add);
      } else {
        add(outline.from(k), outline.to(k));
      }
    }
  }

  /// Adds the intervals of the segment from a to b that no other piece covers.
  template <class Add>
  void addUncovered(std::uint32_t at, const glm::dvec2& a, const glm::dvec2& b, Add& add) const noexcept {
    const Aabb box = boxOf(minima_[at], tolerance_ + kRegionDirection * minima_[at].radius);
    double done = 0.0;
    while (done < 1.0) {
      double reach = done, next = 1.0;
      neighbours_.boxes.forEachAt(box, [&](std::uint32_t i) {
        const Interval covered = coveredBy(i, at, a, b);
        if (!(covered.to > covered.from)) return;
        if (covered.from <= done) reach = std::max(reach, covered.to);
        if (covered.from > done) next = std::min(next, covered.from);
      });
      if (reach > done) {
        done = reach;
      } else {
        add(a + done * (b - a), a + next * (b - a));
        done = next;
      }
    }
  }

  Interval coveredBy(std::uint32_t other, std::uint32_t at, const glm::dvec2& a,
                     const glm::dvec2& b) const noexcept {
    if (other == at || neighbours_.region[other] != neighbours_.region[at]) return {0.0, 0.0};
    const Minimum &piece = minima_[at], &cover = minima_[other];
    const double reach = piece.radius + cover.radius;
    const glm::dvec3 apart = piece.lmd.scenePoint - cover.lmd.scenePoint;
    const bool isNear = isPiece(cover) && cover.isOverlapping && glm::dot(apart, apart) <= reach * reach;
    if (!isNear) return {0.0, 0.0};
    const Outline outline(cover, plane_);
    const bool isEarlier = featureKey(cover) < featureKey(piece);
    if (piece.dimension == 2) return coveredByPolygon(a, b, outline, isEarlier, tolerance_);
    return isEarlier ? coveredBySegment(a, b, outline, tolerance_) : Interval{0.0, 0.0};
  }

  void setExtent(const Moments& m, const glm::dvec2& centroid, RegionExtent& extent) const noexcept {
    const double xx = m.xx / m.measure - centroid.x * centroid.x,
                 yy = m.yy / m.measure - centroid.y * centroid.y,
                 xy = m.xy / m.measure - centroid.x * centroid.y;
    const double mean = 0.5 * (xx + yy), spread = std::hypot(0.5 * (xx - yy), xy);
    // Length and width are equal but for rounding: any axis will do if it is always the same.
    constexpr double kRound = 1e-9;
    const double angle = spread > kRound * mean ? 0.5 * std::atan2(2.0 * xy, xx - yy) : 0.0;
    const glm::dvec2 axis(std::cos(angle), std::sin(angle)), across(-axis.y, axis.x);
    extent.dimension = dimension_;
    extent.measure = m.measure;
    extent.axis = plane_.along(axis);
    // The second moment of a rectangle is a third of its half length squared.
    extent.halfLength = std::sqrt(3.0 * std::max(0.0, mean + spread));
    extent.halfWidth = dimension_ == 2 ? std::sqrt(3.0 * std::max(0.0, mean - spread)) : 0.0;
    const glm::dvec2 inside = pointInside(centroid) - centroid;
    extent.inside = {glm::dot(inside, axis), glm::dot(inside, across)};
  }

  /// Returns the centroid if a piece holds it, else that of the largest piece.
  glm::dvec2 pointInside(const glm::dvec2& centroid) const noexcept {
    const bool isInside = std::any_of(group_.begin(), group_.end(), [&](std::uint32_t i) {
      const Minimum& m = minima_[i];
      const double far = m.radius + tolerance_;
      const glm::dvec2 apart = plane_.map(m.lmd.scenePoint) - centroid;
      return isPiece(m) && glm::dot(apart, apart) <= far * far &&
             Outline(m, plane_).contains(centroid, tolerance_);
    });
    return isInside ? centroid : plane_.map(largest_.lmd.scenePoint);
  }

  std::span<const Minimum> minima_;
  std::span<const std::uint32_t> group_;
  const RegionNeighbours& neighbours_;
  double tolerance_;
  std::uint8_t dimension_;
  const Minimum& largest_;
  glm::dvec3 direction_;
  Plane plane_;
};

}  // namespace

Lmd uniteRegion(std::span<const Minimum> minima, std::span<const std::uint32_t> group,
                const RegionNeighbours& neighbours, double tolerance) noexcept {
  std::uint8_t dimension = 0;
  for (const std::uint32_t i : group)
    dimension = std::max(dimension, minima[i].dimension);
  const RegionUnion region(minima, group, neighbours, tolerance, dimension);
  const Moments moments = region.moments();
  if (!region.isStripOfLongerEdges(moments.measure)) return region.unite(moments);
  const RegionUnion edges(minima, group, neighbours, tolerance, 1);
  return edges.unite(edges.moments());
}

}  // namespace nearfit
