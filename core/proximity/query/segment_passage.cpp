#include "core/proximity/query/segment_passage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "core/math/plane_cross.h"

namespace nearfit {
namespace {

/// True if the origin lies left of the line from a to b, by the exact sign of a.x b.y - a.y b.x. On the line
/// it counts as shifted infinitesimally along x, and by an even smaller amount along y, so it is always on
/// exactly one side of an edge.
bool isLeft(const glm::dvec2& a, const glm::dvec2& b) noexcept {
  const double ab = a.x * b.y, ba = a.y * b.x;
  if (ab != ba) return ab > ba;  // Rounding is monotonic.
  const double abRest = std::fma(a.x, b.y, -ab), baRest = std::fma(a.y, b.x, -ba);
  if (abRest != baRest) return abRest > baRest;
  return a.y != b.y ? a.y > b.y : b.x > a.x;
}

bool holdsOrigin(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) noexcept {
  const bool side = isLeft(a, b);
  return isLeft(b, c) == side && isLeft(c, a) == side;
}

}  // namespace

SegmentPassage::SegmentPassage(const glm::dvec3& start, const glm::dvec3& direction, double from, double to,
                               double clearance) noexcept
    : start_(start), z_(direction), from_(from), to_(to), clearance_(clearance) {
  // Any axes across will do; these are by Duff et al. 2017.
  const double sign = std::copysign(1.0, z_.z), a = -1.0 / (sign + z_.z), b = z_.x * z_.y * a;
  x_ = {1.0 + sign * z_.x * z_.x * a, sign * b, -sign * z_.x};
  y_ = {b, sign + z_.y * z_.y * a, -z_.y};
}

std::uint32_t SegmentPassage::linesAcross(const glm::dvec2& a, const glm::dvec2& b,
                                          const glm::dvec2& c) const noexcept {
  static constexpr double kDiagonal = 0.5 * std::numbers::sqrt2;
  static constexpr std::array<glm::dvec2, kLines> kAround{{{1.0, 0.0},
                                                           {kDiagonal, kDiagonal},
                                                           {0.0, 1.0},
                                                           {-kDiagonal, kDiagonal},
                                                           {-1.0, 0.0},
                                                           {-kDiagonal, -kDiagonal},
                                                           {0.0, -1.0},
                                                           {kDiagonal, -kDiagonal}}};
  std::uint32_t lines = 0;
  for (std::uint32_t i = 0; i < kLines; ++i) {
    const glm::dvec2 line = clearance_ * kAround[i];
    if (holdsOrigin(a - line, b - line, c - line)) lines |= 1U << i;
  }
  return lines;
}

void SegmentPassage::add(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept {
  const glm::dvec3 wa = a - start_, wb = b - start_, wc = c - start_;
  // Cheap tests first: most triangles near an end lie wholly behind it, and most others off to one side.
  const glm::dvec3 z(glm::dot(wa, z_), glm::dot(wb, z_), glm::dot(wc, z_));
  const double lowest = std::min({z.x, z.y, z.z}), highest = std::max({z.x, z.y, z.z});
  if (lowest > to_ || highest < from_) return;
  const glm::dvec3 x(glm::dot(wa, x_), glm::dot(wb, x_), glm::dot(wc, x_));
  if (std::min({x.x, x.y, x.z}) > clearance_ || std::max({x.x, x.y, x.z}) < -clearance_) return;
  const glm::dvec3 y(glm::dot(wa, y_), glm::dot(wb, y_), glm::dot(wc, y_));
  if (std::min({y.x, y.y, y.z}) > clearance_ || std::max({y.x, y.y, y.z}) < -clearance_) return;
  const glm::dvec2 pa(x.x, y.x), pb(x.y, y.y), pc(x.z, y.z);

  // All eight lines are on one side of an edge that is farther from the segment than the lines are. The sum
  // of the edge's extents bounds its length.
  const std::array<double, 3> areas{cross(pb, pc), cross(pc, pa), cross(pa, pb)};
  const auto reach = [this](const glm::dvec2& from, const glm::dvec2& to) {
    constexpr double kRounding = 1.0 + 1e-9;
    return kRounding * clearance_ * (std::abs(to.x - from.x) + std::abs(to.y - from.y));
  };
  const std::array<double, 3> reaches{reach(pb, pc), reach(pc, pa), reach(pa, pb)};
  bool isClear = true, isLeftOfAll = true, isRightOfAll = true;
  for (std::size_t k = 0; k < 3; ++k) {
    isClear = isClear && std::abs(areas[k]) > reaches[k];
    isLeftOfAll = isLeftOfAll && areas[k] > -reaches[k];
    isRightOfAll = isRightOfAll && areas[k] < reaches[k];
  }
  if (!isLeftOfAll && !isRightOfAll) return;
  const std::uint32_t lines = isClear ? kAll : linesAcross(pa, pb, pc);
  if (lines == 0) return;

  const double sum = areas[0] + areas[1] + areas[2];
  const double weighted = areas[0] * z.x + areas[1] * z.y + areas[2] * z.z;
  // A face nearly parallel to the segment is crossed somewhere along its height.
  const double at = sum != 0.0 ? std::clamp(weighted / sum, lowest, highest) : 0.5 * (lowest + highest);
  if (at > from_ && at < to_) barred_ |= lines;
}

}  // namespace nearfit
