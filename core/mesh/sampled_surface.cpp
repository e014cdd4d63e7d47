#include "core/mesh/sampled_surface.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <unordered_map>

#include <glm/geometric.hpp>

#include "core/base/error.h"
#include "core/mesh/shaded_mesh.h"

namespace nearfit {
namespace {

/// Sides away from what is near may be longer by this share of their distance from it. With a quarter, a triangle
/// around all that is near is still cut: its longest side is nearer to any point of it than it is long.
constexpr double kGrading = 0.25;
/// Depth at which a triangle is not cut further. A side is halved 50 times only if it is 1e15 times too long.
constexpr int kMaxCuts = 64;
/// Fewest samples per area in squared sides: of equilateral triangles whose sides are as long as allowed, a sample for
/// two, and half of that to be sure.
constexpr double kMinPerArea = 0.5;
/// Factor to the next length that is tried if there are too many samples.
const double kCoarser = std::sqrt(2.0);
/// Triangles between checks for cancelling.
constexpr std::size_t kBetweenSteps = 4096;

double gapBetween(const Aabb& box, const glm::dvec3& point) noexcept {
  return glm::length(glm::max(glm::max(box.lower - point, point - box.upper), glm::dvec3(0.0)));
}

double areaOf(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) noexcept {
  return 0.5 * glm::length(glm::cross(b - a, c - a));
}

/// One attempt to cut a mesh.
class SurfaceCutter {
 public:
  SurfaceCutter(const TriangleMesh& mesh, const ShadedMesh& shaded, const Sampling& sampling)
      : shaded_(shaded),
        sampling_(sampling),
        maxPoints_(std::max(sampling.maxSamples, shaded.vertices.size())) {
    surface_.maxSide = sampling.maxSide;
    surface_.normals = shaded.normals;
    surface_.points.reserve(shaded.vertices.size());
    for (const std::uint32_t vertex : shaded.vertices)
      surface_.points.push_back(mesh.vertices()[vertex]);
    surface_.triangles.reserve(shaded.triangles.size());
    surface_.firstOf.reserve(shaded.triangles.size() + 1);
  }

  /// Nullopt if there are too many samples.
  std::optional<SampledSurface> cut(const ProgressCallback& progress) {
    for (std::size_t i = 0; i < shaded_.triangles.size(); ++i) {
      surface_.firstOf.push_back(static_cast<std::uint32_t>(surface_.triangles.size()));
      add(shaded_.triangles[i], 0);
      if (surface_.points.size() > maxPoints_) return std::nullopt;
      const double done = static_cast<double>(i) / static_cast<double>(shaded_.triangles.size());
      if (i % kBetweenSteps == 0 && progress && !progress(done)) throw Cancelled();
    }
    surface_.firstOf.push_back(static_cast<std::uint32_t>(surface_.triangles.size()));
    finish();
    return std::move(surface_);
  }

 private:
  bool isLong(std::uint32_t a, std::uint32_t b) const noexcept {
    const glm::dvec3 &p = surface_.points[a], &q = surface_.points[b];
    const double length = glm::distance(p, q);
    if (!(length > sampling_.maxSide)) return false;
    if (!sampling_.near) return true;
    return length > sampling_.maxSide + kGrading * gapBetween(*sampling_.near, 0.5 * (p + q));
  }

  std::uint32_t middleOf(std::uint32_t a, std::uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    const auto next = static_cast<std::uint32_t>(surface_.points.size());
    const auto [at, isNew] = middles_.try_emplace(std::uint64_t{low} << 32U | high, next);
    if (isNew) {
      surface_.points.push_back(0.5 * (surface_.points[low] + surface_.points[high]));
      // Not of length 1 yet: so they are linear over a triangle, as when it is drawn.
      surface_.normals.push_back(0.5F * (surface_.normals[low] + surface_.normals[high]));
    }
    return at->second;
  }

  void add(const Triangle& t, int cuts) {
    std::array<bool, 3> isCut{};
    int count = 0;
    // A length does not depend on the order of its ends, so both triangles of a side cut it or neither does.
    for (std::size_t k = 0; k < 3 && cuts < kMaxCuts; ++k) {
      const std::uint32_t a = std::min(t[k], t[(k + 1) % 3]), b = std::max(t[k], t[(k + 1) % 3]);
      isCut[k] = isLong(a, b);
      count += isCut[k] ? 1 : 0;
    }
    if (surface_.points.size() > maxPoints_) return;
    switch (count) {
      case 0:
        surface_.triangles.push_back(t);
        return;
      case 1:
        return addHalves(t, isCut[0] ? 0 : isCut[1] ? 1 : 2, cuts + 1);
      case 2:
        return addThree(t, !isCut[0] ? 0 : !isCut[1] ? 1 : 2, cuts + 1);
      default:
        break;
    }
    const std::array<std::uint32_t, 3> m{middleOf(t[0], t[1]), middleOf(t[1], t[2]), middleOf(t[2], t[0])};
    for (std::size_t k = 0; k < 3; ++k)
      add({t[k], m[k], m[(k + 2) % 3]}, cuts + 1);
    add({m[0], m[1], m[2]}, cuts + 1);
  }

  /// @param side  The one that is cut, from that corner to the next.
  void addHalves(const Triangle& t, std::size_t side, int cuts) {
    const std::uint32_t a = t[side], b = t[(side + 1) % 3], c = t[(side + 2) % 3], m = middleOf(a, b);
    add({a, m, c}, cuts);
    add({m, b, c}, cuts);
  }

  /// @param side  The one that is not cut.
  void addThree(const Triangle& t, std::size_t side, int cuts) {
    const std::uint32_t a = t[side], b = t[(side + 1) % 3], c = t[(side + 2) % 3];
    const std::uint32_t m = middleOf(b, c), n = middleOf(c, a);
    add({n, m, c}, cuts);
    const auto& p = surface_.points;
    if (glm::distance(p[a], p[m]) <= glm::distance(p[b], p[n])) {
      add({a, b, m}, cuts);
      add({a, m, n}, cuts);
    } else {
      add({a, b, n}, cuts);
      add({b, m, n}, cuts);
    }
  }

  void finish() {
    for (glm::vec3& normal : surface_.normals) {
      const float length = glm::length(normal);
      normal = length > 0.0F ? normal / length : glm::vec3(0.0F);
    }
    surface_.areas.assign(surface_.points.size(), 0.0);
    const auto& p = surface_.points;
    for (const Triangle& t : surface_.triangles) {
      const double share = areaOf(p[t[0]], p[t[1]], p[t[2]]) / 3.0;
      for (const std::uint32_t corner : t)
        surface_.areas[corner] += share;
    }
  }

  const ShadedMesh& shaded_;
  const Sampling& sampling_;
  const std::size_t maxPoints_;
  SampledSurface surface_;
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;  ///< By the two ends, the lower one first.
};

/// A length below which there are surely more samples than allowed [m].
double leastSide(const TriangleMesh& mesh, const Sampling& sampling) {
  if (sampling.near) return 0.0;
  double area = 0.0;
  for (const Triangle& t : mesh.triangles())
    area += areaOf(mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]);
  return std::sqrt(kMinPerArea * area / static_cast<double>(std::max<std::size_t>(1, sampling.maxSamples)));
}

}  // namespace

SampledSurface sampleSurface(const TriangleMesh& mesh, const Sampling& sampling,
                             const ProgressCallback& progress) {
  assert(sampling.maxSide > 0.0 && std::isfinite(sampling.maxSide));
  const ShadedMesh shaded = shadedMesh(mesh, kSharpAngle);
  // Another attempt begins anew.
  double reported = 0.0;
  const ProgressCallback rising = [&](double fraction) {
    reported = std::max(reported, fraction);
    return !progress || progress(reported);
  };
  Sampling tried = sampling;
  tried.maxSide = std::max(sampling.maxSide, leastSide(mesh, sampling));
  // Ends at the latest when no side is long.
  for (;; tried.maxSide *= kCoarser) {
    std::optional<SampledSurface> surface = SurfaceCutter(mesh, shaded, tried).cut(rising);
    if (!surface) continue;
    surface->isCoarse = tried.maxSide > sampling.maxSide;
    return std::move(*surface);
  }
}

}  // namespace nearfit
