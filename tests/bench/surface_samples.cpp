#include "tests/bench/surface_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <unordered_map>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/math/aabb.h"
#include "tests/bench/portable_random.h"

namespace nearfit::bench {
namespace {

/// Random points a square of the spacing, of which those are kept that are not too near to a kept one.
constexpr double kTrials = 12.0;
constexpr double kAround = 2.5;
constexpr std::uint32_t kBallLeaf = 8;
/// Cosine between normals below which two points are on different sides of a wall.
constexpr double kSameSide = -0.5;

/// Points by the cube of a grid that they are in.
class Grid {
 public:
  explicit Grid(double side) : side_(side) {}

  void add(const glm::dvec3& p, std::uint32_t index) { cells_[keyOf(cellOf(p))].push_back(index); }

  /// Those in the cube of p and the 26 around it: all within a side, and more.
  template <class Visit>
  void forNear(const glm::dvec3& p, Visit&& visit) const {
    const auto cell = cellOf(p);
    for (std::int64_t i = 0; i < 27; ++i) {
      const auto found =
          cells_.find(keyOf({cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1}));
      if (found == cells_.end()) continue;
      for (const std::uint32_t index : found->second)
        visit(index);
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  Cell cellOf(const glm::dvec3& p) const {
    return {static_cast<std::int64_t>(std::floor(p.x / side_)),
            static_cast<std::int64_t>(std::floor(p.y / side_)),
            static_cast<std::int64_t>(std::floor(p.z / side_))};
  }
  static std::int64_t keyOf(const Cell& c) {
    constexpr std::int64_t kMax = 1 << 20;
    return ((c[0] + kMax) * 2 * kMax + c[1] + kMax) * 2 * kMax + c[2] + kMax;
  }

  double side_;
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace

std::vector<SurfaceSamples::Candidate> SurfaceSamples::candidatesOn(const TriangleMesh& mesh,
                                                                    double spacing) {
  const auto x = mesh.vertices();
  std::mt19937_64 random(1);
  Grid grid(spacing);
  std::vector<Candidate> kept;
  std::vector<double> areaTo;
  for (const Triangle& t : mesh.triangles()) {
    const double area = 0.5 * glm::length(glm::cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]));
    areaTo.push_back(area + (areaTo.empty() ? 0.0 : areaTo.back()));
  }
  const auto trials = static_cast<std::size_t>(std::ceil(kTrials * areaTo.back() / (spacing * spacing)));
  for (std::size_t i = 0; i < trials; ++i) {
    const auto where = std::ranges::upper_bound(areaTo, uniform(random) * areaTo.back());
    const Triangle& t =
        mesh.triangles()[static_cast<std::size_t>(std::min(where, areaTo.end() - 1) - areaTo.begin())];
    const double root = std::sqrt(uniform(random)), share = uniform(random);
    const glm::dvec3 point =
        x[t[0]] + root * (1.0 - share) * (x[t[1]] - x[t[0]]) + root * share * (x[t[2]] - x[t[0]]);
    bool isFree = true;
    grid.forNear(point,
                 [&](std::uint32_t k) { isFree = isFree && glm::distance(kept[k].point, point) >= spacing; });
    if (!isFree) continue;
    grid.add(point, static_cast<std::uint32_t>(kept.size()));
    kept.push_back({point, glm::normalize(glm::cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]))});
  }
  return kept;
}

SurfaceSamples::SurfaceSamples(const TriangleMesh& mesh, double spacing) {
  std::vector<Candidate> all = candidatesOn(mesh, spacing);
  balls_.push_back({{}, 0.0, 0, static_cast<std::uint32_t>(all.size()), 0});
  build(0, all);
  for (const Candidate& c : all)
    points_.push_back(c.point);
  findAround(all, kAround * spacing);
}

void SurfaceSamples::build(std::uint32_t index, std::span<Candidate> all) {
  const std::span<Candidate> own = all.subspan(balls_[index].first, balls_[index].count);
  Aabb box;
  for (const Candidate& c : own)
    box.add(c.point);
  balls_[index].centre = box.centre();
  for (const Candidate& c : own)
    balls_[index].radius = std::max(balls_[index].radius, glm::distance(c.point, box.centre()));
  if (own.size() <= kBallLeaf) return;
  const glm::dvec3 size = box.upper - box.lower;
  const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t first = balls_[index].first, half = balls_[index].count / 2;
  std::nth_element(own.begin(), own.begin() + half, own.end(),
                   [&](const Candidate& a, const Candidate& b) { return a.point[axis] < b.point[axis]; });
  const auto child = static_cast<std::uint32_t>(balls_.size());
  const std::uint32_t rest = balls_[index].count - half;
  balls_[index].child = child;
  balls_.push_back({{}, 0.0, first, half, 0});
  balls_.push_back({{}, 0.0, first + half, rest, 0});
  build(child, all);
  build(child + 1, all);
}

void SurfaceSamples::findAround(std::span<const Candidate> all, double reach) {
  Grid grid(reach);
  for (std::uint32_t i = 0; i < all.size(); ++i)
    grid.add(all[i].point, i);
  first_.push_back(0);
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    grid.forNear(all[i].point, [&](std::uint32_t k) {
      if (k != i && glm::distance(all[k].point, all[i].point) <= reach &&
          glm::dot(all[k].normal, all[i].normal) > kSameSide) {
        around_.push_back(k);
      }
    });
    first_.push_back(static_cast<std::uint32_t>(around_.size()));
  }
}

std::size_t SurfaceSamples::byteSize() const noexcept {
  return points_.size() * sizeof(glm::dvec3) + (first_.size() + around_.size()) * sizeof(std::uint32_t) +
         balls_.size() * sizeof(Ball);
}

}  // namespace nearfit::bench
