#include "core/mesh/vertex_welding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "core/math/aabb.h"

namespace nearfit {
namespace {

constexpr std::uint32_t kNoPoint = std::numeric_limits<std::uint32_t>::max();

/// Cell width in tolerances. A point's neighbourhood then mostly lies in one cell, and a cell holds few
/// points even if they are as close as possible.
constexpr double kCellTolerances = 8.0;
/// Min cell width as a fraction of the box, so that cell numbers fit into 64 bits.
constexpr double kNarrowestCell = 1e-15;

struct Cell {
  std::int64_t x, y, z;
};

std::uint64_t hashOf(const Cell& cell) {
  std::uint64_t h = 0;
  for (const std::int64_t c : {cell.x, cell.y, cell.z}) {
    h = (h ^ static_cast<std::uint64_t>(c)) * 0x9E3779B97F4A7C15U;
    h ^= h >> 32;
  }
  return h;
}

/// Finds representatives by position.
class Grid {
 public:
  Grid(std::span<const glm::dvec3> points, const Aabb& box, double tolerance)
      : points_(points),
        origin_(box.lower),
        tolerance_(tolerance),
        cellSize_(std::max(kCellTolerances * tolerance, kNarrowestCell * box.diagonal())),
        first_(std::bit_ceil(2 * points.size() + 1), kNoPoint),
        next_(points.size(), kNoPoint) {}

  /// First of the added points that is close to `p`; kNoPoint if none.
  std::uint32_t find(const glm::dvec3& p) const {
    const Cell low = cellOf(p - tolerance_), high = cellOf(p + tolerance_);
    std::uint32_t found = kNoPoint;
    for (std::int64_t x = low.x; x <= high.x; ++x) {
      for (std::int64_t y = low.y; y <= high.y; ++y) {
        for (std::int64_t z = low.z; z <= high.z; ++z)
          found = std::min(found, findInCell({x, y, z}, p));
      }
    }
    return found;
  }
  void add(std::uint32_t index) {
    std::uint32_t& head = first_[hashOf(cellOf(points_[index])) & (first_.size() - 1)];
    next_[index] = head;
    head = index;
  }

 private:
  Cell cellOf(const glm::dvec3& p) const {
    const glm::dvec3 c = glm::floor((p - origin_) / cellSize_);
    return {static_cast<std::int64_t>(c.x), static_cast<std::int64_t>(c.y), static_cast<std::int64_t>(c.z)};
  }
  std::uint32_t findInCell(const Cell& cell, const glm::dvec3& p) const {
    std::uint32_t found = kNoPoint;
    for (std::uint32_t i = first_[hashOf(cell) & (first_.size() - 1)]; i != kNoPoint; i = next_[i]) {
      if (i < found && areClose(points_[i], p)) found = i;
    }
    return found;
  }
  bool areClose(const glm::dvec3& a, const glm::dvec3& b) const {
    return tolerance_ == 0.0 ? a == b : glm::distance(a, b) <= tolerance_;
  }

  std::span<const glm::dvec3> points_;
  glm::dvec3 origin_;
  double tolerance_, cellSize_;
  std::vector<std::uint32_t> first_;  ///< By hash of the cell: the last point added.
  std::vector<std::uint32_t> next_;   ///< By point: the previous point with the same hash.
};

}  // namespace

std::vector<std::uint32_t> weldPoints(std::span<const glm::dvec3> points, double tolerance) {
  Aabb box;
  for (const glm::dvec3& p : points)
    box.add(p);
  std::vector<std::uint32_t> representative(points.size(), 0);
  if (box.diagonal() <= tolerance) return representative;
  Grid grid(points, box, tolerance);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const std::uint32_t found = grid.find(points[i]);
    representative[i] = found == kNoPoint ? i : found;
    if (found == kNoPoint) grid.add(i);
  }
  return representative;
}

}  // namespace nearfit
