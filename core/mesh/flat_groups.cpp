#include "core/mesh/flat_groups.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include "core/math/symmetric_eigen.h"

namespace nearfit {
namespace {

/// Max distance of a corner from the plane of its flat, in roundings of a coordinate: those of a point's three
/// coordinates, and as much for the plane, which is known from such points.
constexpr double kRoundingsOfPlane = 4.0;
/// No coarser rounding counts, as a fraction of the mesh's diagonal: numbers with few digits are round, not
/// rounded.
constexpr double kMaxTolerance = 1e-6;
/// Coordinates are rounded at least this much, as a fraction of the largest: by scaling to metres, welding, and
/// cutting flats finer again and again.
constexpr double kMinRounding = 64.0 * std::numeric_limits<double>::epsilon();

/// Max times that a flat's plane is fitted anew and the triangles beside it are tried again. A plane known from
/// a few small triangles reaches about twice as far with each fit.
constexpr int kMaxFits = 64;

/// Number of triangles between two reports of progress.
constexpr std::size_t kSeedsBetweenReports = 16384;

/// Area, first and second moments of triangles about a point, each triangle as its corners.
struct CornerMoments {
  double weight = 0.0;
  glm::dvec3 first{0.0};
  glm::dmat3 second{0.0};

  void add(const glm::dvec3& p, double by) {
    weight += by;
    first += by * p;
    second += by * glm::outerProduct(p, p);
  }
};

class FlatFinder {
 public:
  FlatFinder(const TriangleMesh& mesh, double tolerance)
      : mesh_(mesh),
        x_(mesh.vertices()),
        tolerance_(tolerance),
        tried_(mesh.triangles().size(), kNoFlat),
        areas_(mesh.triangles().size()) {
    out_.flatOf.assign(mesh.triangles().size(), kNoFlat);
  }

  FlatGroups find(const std::function<void(double)>& onProgress) {
    const std::vector<std::uint32_t> seeds = seedsBySize();
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      if (i % kSeedsBetweenReports == 0 && onProgress)
        onProgress(static_cast<double>(i) / static_cast<double>(seeds.size()));
      if (out_.flatOf[seeds[i]] == kNoFlat) growFrom(seeds[i]);
    }
    if (onProgress) onProgress(1.0);
    return std::move(out_);
  }

 private:
  /// Twice the area, along the normal.
  glm::dvec3 doubleArea(std::uint32_t t) const {
    const Triangle& c = mesh_.triangles()[t];
    return glm::cross(x_[c[1]] - x_[c[0]], x_[c[2]] - x_[c[0]]);
  }
  double longestSide(std::uint32_t t) const {
    const Triangle& c = mesh_.triangles()[t];
    const glm::dvec3 a = x_[c[1]] - x_[c[0]], b = x_[c[2]] - x_[c[1]], d = x_[c[0]] - x_[c[2]];
    return std::sqrt(std::max({glm::dot(a, a), glm::dot(b, b), glm::dot(d, d)}));
  }
  /// True for a triangle without a reliable normal: it starts no flat, and joins one whatever its normal.
  bool isThin(std::uint32_t t) const { return !(areas_[t] > kReliableHeight * tolerance_ * longestSide(t)); }

  /// Triangles that can start a flat, the largest first: their planes reach farthest.
  std::vector<std::uint32_t> seedsBySize() {
    std::vector<std::uint32_t> seeds;
    for (std::uint32_t t = 0; t < areas_.size(); ++t) {
      areas_[t] = glm::length(doubleArea(t));
      if (!isThin(t)) seeds.push_back(t);
    }
    std::ranges::sort(seeds, [this](std::uint32_t a, std::uint32_t b) {
      return areas_[a] != areas_[b] ? areas_[a] > areas_[b] : a < b;
    });
    return seeds;
  }

  bool lies(std::uint32_t t, const FlatPlane& plane) const {
    for (const std::uint32_t v : mesh_.triangles()[t]) {
      if (!(std::abs(plane.height(x_[v])) <= tolerance_)) return false;
    }
    return isThin(t) || glm::dot(doubleArea(t), plane.normal) > 0.0;
  }

  void growFrom(std::uint32_t seed) {
    const glm::dvec3 normal = doubleArea(seed) / areas_[seed];
    FlatPlane plane{x_[mesh_.triangles()[seed][0]], normal};
    grow(seed, plane);
    if (members_.size() < 2) return;
    // A triangle taken for an earlier plane may be off the last one.
    if (!std::ranges::all_of(members_, [&](std::uint32_t t) { return lies(t, plane); })) {
      if (!lies(seed, plane)) return;
      gather(seed, plane);
      if (members_.size() < 2) return;
    }
    const auto flat = static_cast<std::uint32_t>(out_.planes.size());
    for (const std::uint32_t t : members_)
      out_.flatOf[t] = flat;
    out_.planes.push_back(plane);
  }

  /// Gathers the triangles around the seed that lie in the plane, which is fitted to them on the way.
  void grow(std::uint32_t seed, FlatPlane& plane) {
    begin(seed);
    moments_ = {};
    addMoments(seed, plane.origin);
    std::size_t nextFit = 2;
    for (int round = 0; round < kMaxFits; ++round) {
      while (next_ < members_.size()) {
        visitNeighbours(members_[next_++], plane, [&](std::uint32_t t) {
          addMoments(t, plane.origin);
          if (members_.size() < nextFit) return;
          fit(plane);
          nextFit *= 2;
        });
      }
      if (members_.size() < 2) return;
      refine(plane, fit(plane));
      // Those beside it may lie in the better plane.
      std::vector<std::uint32_t> beside = std::exchange(beside_, {});
      for (const std::uint32_t t : beside) {
        if (tried_[t] == seed) continue;
        if (lies(t, plane)) {
          take(t, seed);
          addMoments(t, plane.origin);
        } else {
          beside_.push_back(t);
        }
      }
      if (next_ == members_.size()) return;
    }
  }

  /// Gathers the triangles around the seed that lie in a given plane.
  void gather(std::uint32_t seed, const FlatPlane& plane) {
    for (const std::uint32_t t : members_)
      tried_[t] = kNoFlat;
    begin(seed);
    while (next_ < members_.size())
      visitNeighbours(members_[next_++], plane, [](std::uint32_t) {});
  }

  void begin(std::uint32_t seed) {
    members_.clear();
    beside_.clear();
    next_ = 0;
    seed_ = seed;
    take(seed, seed);
  }
  void take(std::uint32_t t, std::uint32_t seed) {
    tried_[t] = seed;
    members_.push_back(t);
  }

  /// Takes the neighbours that lie in the plane, and calls taken(t) for each.
  template <class Taken>
  void visitNeighbours(std::uint32_t of, const FlatPlane& plane, Taken taken) {
    for (const std::uint32_t e : mesh_.edgesOfTriangle(of)) {
      if (!mesh_.isEdgeConsistent(e)) continue;
      const auto faces = mesh_.facesOfEdge(e);
      const std::uint32_t t = faces[0] == of ? faces[1] : faces[0];
      if (out_.flatOf[t] != kNoFlat || tried_[t] == seed_) continue;
      if (!lies(t, plane)) {
        beside_.push_back(t);
        continue;
      }
      take(t, seed_);
      taken(t);
    }
  }

  void addMoments(std::uint32_t t, const glm::dvec3& about) {
    for (const std::uint32_t v : mesh_.triangles()[t])
      moments_.add(x_[v] - about, areas_[t]);
  }

  void moveOrigin(FlatPlane& plane, const glm::dvec3& shift) {
    plane.origin += shift;
    // CornerMoments about the new origin.
    moments_.second -= glm::outerProduct(shift, moments_.first) + glm::outerProduct(moments_.first, shift) -
                       moments_.weight * glm::outerProduct(shift, shift);
    moments_.first -= moments_.weight * shift;
  }

  /// Moves the plane to where the members' corners are nearest to it, by their moments; its origin, about which
  /// these are, moves along the normal only. Returns the two axes of the members in the plane.
  std::array<glm::dvec3, 2> fit(FlatPlane& plane) {
    if (!(moments_.weight > 0.0)) return {};
    const glm::dvec3 mean = moments_.first / moments_.weight;
    const glm::dmat3 spread = moments_.second / moments_.weight - glm::outerProduct(mean, mean);
    const SymmetricEigen eigen = symmetricEigen(spread);
    const glm::dvec3 n = eigen.vectors[0];
    plane.normal = glm::dot(n, plane.normal) < 0.0 ? -n : n;
    const glm::dvec3 shift = glm::dot(mean, plane.normal) * plane.normal;
    moveOrigin(plane, shift);
    return {eigen.vectors[1], eigen.vectors[2]};
  }

  /// Takes away what rounding of the moments has left: the plane of a long narrow flat is tilted across it.
  void refine(FlatPlane& plane, const std::array<glm::dvec3, 2>& axes) {
    const glm::dvec3 mean = moments_.first / moments_.weight;
    double weight = 0.0, height = 0.0;
    std::array<double, 2> square{}, slope{};
    for (const std::uint32_t t : members_) {
      for (const std::uint32_t v : mesh_.triangles()[t]) {
        const glm::dvec3 w = x_[v] - plane.origin;
        const double h = plane.height(x_[v]);
        weight += areas_[t];
        height += areas_[t] * h;
        for (std::size_t k = 0; k < 2; ++k) {
          const double along = glm::dot(w - mean, axes[k]);
          square[k] += areas_[t] * along * along;
          slope[k] += areas_[t] * along * h;
        }
      }
    }
    if (!(weight > 0.0)) return;
    const glm::dvec3 middle = plane.origin + mean + height / weight * plane.normal;
    glm::dvec3 normal = plane.normal;
    for (std::size_t k = 0; k < 2; ++k) {
      if (square[k] > 0.0) normal -= slope[k] / square[k] * axes[k];
    }
    plane.normal = glm::normalize(normal);
    moveOrigin(plane, glm::dot(middle - plane.origin, plane.normal) * plane.normal);
  }

  const TriangleMesh& mesh_;
  std::span<const glm::dvec3> x_;
  double tolerance_;
  FlatGroups out_;
  std::vector<std::uint32_t> tried_;  ///< By triangle: the last seed whose flat took it.
  std::vector<double> areas_;         ///< Twice the area.
  std::vector<std::uint32_t> members_, beside_;
  std::size_t next_ = 0;
  std::uint32_t seed_ = kNoFlat;
  CornerMoments moments_;
};

}  // namespace

double flatTolerance(const TriangleMesh& mesh, double coordinateRounding) {
  if (mesh.bounds().isEmpty()) return 0.0;
  const double least = kMinRounding * mesh.bounds().largestCoordinate();
  const double rounding = std::max(coordinateRounding, least);
  return std::max(std::min(kRoundingsOfPlane * rounding, kMaxTolerance * mesh.bounds().diagonal()), least);
}

FlatGroups findFlats(const TriangleMesh& mesh, double tolerance,
                     const std::function<void(double fraction)>& onProgress) {
  return FlatFinder(mesh, tolerance).find(onProgress);
}

}  // namespace nearfit
