#include "core/mesh/check/crossing_triangles.h"

#include <algorithm>

#include "core/exact/triangle_predicates.h"
#include "core/math/box_pairs.h"
#include "core/math/clearly_apart.h"

namespace nearfit {
namespace {

/// Max work, in pairs whose boxes overlap: scans have 6 per triangle, turned parts with finely divided caps up to some
/// thousands. A fan of a million needles, which would have 10^12, is given up.
constexpr std::uint64_t kMaxPairWork = 100'000'000, kMaxPairWorkPerTriangle = 100;
/// Cost of a pair that needs exact numbers, relative to one that is clearly apart.
constexpr std::uint64_t kExactPairWork = 32;
/// Nodes of the boxes' hierarchy that cost as much as a pair that is clearly apart. They count too: long boxes that
/// cross without meeting have few pairs, but overlap most nodes.
constexpr std::uint64_t kNodesPerPairWork = 8;
/// Triangles between two reports of progress: some milliseconds.
constexpr std::uint32_t kTrianglesPerReport = 4096;

class CrossingFinder {
 public:
  explicit CrossingFinder(const TriangleMesh& mesh) : mesh_(mesh), boxes_(mesh.triangles().size()) {
    for (std::uint32_t i = 0; i < mesh.triangles().size(); ++i) {
      const TriangleCorners corners = cornersAt(mesh.triangles()[i]);
      // It covers no surface, and would meet all its neighbours.
      if (hasNoArea(corners)) continue;
      Aabb box;
      for (const glm::dvec3& p : corners)
        box.add(p);
      boxes_.add(box);
      triangles_.push_back(i);
      boxOf_.push_back(box);
    }
    boxes_.build();
  }

  CrossingTriangles find(std::size_t maxPairs, const std::function<void(double)>& report) {
    const std::uint64_t maxWork = kMaxPairWork + kMaxPairWorkPerTriangle * triangles_.size();
    CrossingTriangles result;
    std::uint64_t work = 0;
    for (std::uint32_t first = 0; first < triangles_.size(); ++first) {
      if (first % kTrianglesPerReport == 0)
        report(static_cast<double>(first) / static_cast<double>(triangles_.size()));
      const std::uint64_t nodes = boxes_.forEachAt(boxOf_[first], [&](std::uint32_t second) {
        if (second > first && work <= maxWork && result.pairs.size() <= maxPairs)
          work += judge(triangles_[first], triangles_[second], result);
      });
      work += nodes / kNodesPerPairWork;
      if (work > maxWork || result.pairs.size() > maxPairs) {
        result.isComplete = false;
        break;
      }
    }
    if (result.pairs.size() > maxPairs) result.pairs.resize(maxPairs);
    std::ranges::sort(result.pairs);
    return result;
  }

 private:
  TriangleCorners cornersAt(const Triangle& t) const {
    return {mesh_.vertices()[t[0]], mesh_.vertices()[t[1]], mesh_.vertices()[t[2]]};
  }

  /// Adds the pair if it meets; returns the work it took.
  std::uint64_t judge(std::uint32_t first, std::uint32_t second, CrossingTriangles& result) const {
    Triangle a = mesh_.triangles()[first], b = mesh_.triangles()[second];
    const std::size_t shared = alignSharedCorners(a, b);
    if (shared == 3) return 1;
    const TriangleCorners cornersA = cornersAt(a), cornersB = cornersAt(b);
    if (areClearlyApart(cornersA, cornersB, shared)) return 1;
    if (doTrianglesMeetBeyond(cornersA, cornersB, shared))
      result.pairs.push_back({std::min(first, second), std::max(first, second)});
    return kExactPairWork;
  }

  const TriangleMesh& mesh_;
  BoxPairs boxes_;
  std::vector<std::uint32_t> triangles_;  ///< With an area; by index of their box.
  std::vector<Aabb> boxOf_;
};

}  // namespace

CrossingTriangles findCrossingTriangles(const TriangleMesh& mesh, std::size_t maxPairs,
                                        const ProgressCallback& progress) {
  return CrossingFinder(mesh).find(maxPairs, stageOf(progress, 0.0, 1.0));
}

}  // namespace nearfit
