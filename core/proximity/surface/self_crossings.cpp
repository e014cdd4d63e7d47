#include "core/proximity/surface/self_crossings.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <utility>

#include "core/exact/triangle_predicates.h"
#include "core/math/clearly_apart.h"
#include "core/parallel/parallel_for.h"

namespace nearfit {
namespace {

/// Max work, in pairs whose boxes overlap: scans have 6 per triangle, turned parts with finely divided caps
/// up to some thousands. A fan of a million needles, which would have 10^12, is given up.
constexpr std::uint64_t kMaxWork = 100'000'000, kMaxWorkPerTriangle = 100;
/// Cost of a pair that needs exact numbers, relative to one that is clearly apart.
constexpr std::uint64_t kExactWork = 32;
/// Nodes of the boxes' hierarchy that cost as much as a pair that is clearly apart. They count too: long boxes
/// that cross without meeting have few pairs, but overlap most nodes.
constexpr std::uint64_t kNodesPerPair = 8;
/// Little can be said of a mesh that meets itself more often.
constexpr std::size_t kMaxCrossings = 100'000;

/// Triangles per task of a thread: some milliseconds.
constexpr std::size_t kTrianglesAtOnce = 4096;

TriangleCorners at(const TriangleMesh& mesh, const Triangle& t) {
  return {mesh.vertices()[t[0]], mesh.vertices()[t[1]], mesh.vertices()[t[2]]};
}

class CrossingSearch {
 public:
  CrossingSearch(const TriangleMesh& mesh, const MeshComponents& pieces, const PieceBoxes& boxes)
      : mesh_(mesh),
        pieces_(pieces),
        boxes_(boxes),
        mostWork_(kMaxWork + kMaxWorkPerTriangle * mesh.triangles().size()) {}

  std::optional<std::vector<CrossingPair>> find() {
    const std::size_t count = mesh_.triangles().size();
    parallelFor((count + kTrianglesAtOnce - 1) / kTrianglesAtOnce, [&](std::size_t i) {
      findOf(i * kTrianglesAtOnce, std::min(count, (i + 1) * kTrianglesAtOnce));
    });
    if (isGivenUp_) return std::nullopt;
    std::ranges::sort(found_);
    return std::move(found_);
  }

 private:
  void findOf(std::size_t begin, std::size_t end) {
    std::vector<CrossingPair> found;
    for (const std::uint32_t first : boxes_.triangles().subspan(begin, end - begin)) {
      if (isGivenUp_) break;
      std::uint64_t work = 0;
      const Aabb box = boxOf(cornersOf(mesh_, first));
      const std::uint64_t nodes = boxes_.forEachAt(pieces_.pieceOf[first], box, [&](std::uint32_t second) {
        if (second > first) work += workOf(first, second, found);
      });
      work_ += work + nodes / kNodesPerPair;
      if (work_ > mostWork_ || found.size() > kMaxCrossings) isGivenUp_ = true;
    }
    if (found.empty()) return;
    const std::lock_guard lock(mutex_);
    found_.insert(found_.end(), found.begin(), found.end());
    if (found_.size() > kMaxCrossings) isGivenUp_ = true;
  }

  /// Adds the pair if it meets; returns the work it took.
  std::uint64_t workOf(std::uint32_t first, std::uint32_t second, std::vector<CrossingPair>& found) const {
    Triangle a = mesh_.triangles()[first], b = mesh_.triangles()[second];
    const std::size_t shared = alignSharedCorners(a, b);
    const TriangleCorners cornersA = at(mesh_, a), cornersB = at(mesh_, b);
    if (areClearlyApart(cornersA, cornersB, shared)) return 1;
    if (doTrianglesMeetBeyond(cornersA, cornersB, shared)) found.push_back({first, second});
    return kExactWork;
  }

  const TriangleMesh& mesh_;
  const MeshComponents& pieces_;
  const PieceBoxes& boxes_;
  const std::uint64_t mostWork_;
  std::atomic<std::uint64_t> work_{0};
  std::atomic<bool> isGivenUp_{false};
  std::mutex mutex_;
  std::vector<CrossingPair> found_;
};

}  // namespace

TriangleCorners cornersOf(const TriangleMesh& mesh, std::uint32_t triangle) {
  return at(mesh, mesh.triangles()[triangle]);
}

PieceBoxes::PieceBoxes(const TriangleMesh& mesh, const MeshComponents& pieces)
    : triangles_(pieces.pieceOf.size()), first_(pieces.firstTriangle.size() + 1) {
  for (const std::uint32_t piece : pieces.pieceOf)
    ++first_[piece + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t i = 0; i < triangles_.size(); ++i)
    triangles_[next[pieces.pieceOf[i]]++] = i;
  boxes_.reserve(next.size());
  for (std::size_t piece = 0; piece < next.size(); ++piece) {
    BoxPairs& boxes = boxes_.emplace_back(first_[piece + 1] - first_[piece]);
    for (std::size_t i = first_[piece]; i < first_[piece + 1]; ++i)
      boxes.add(boxOf(cornersOf(mesh, triangles_[i])));
    boxes.build();
  }
}

std::optional<std::vector<CrossingPair>> findSelfCrossings(const TriangleMesh& mesh,
                                                           const MeshComponents& pieces,
                                                           const PieceBoxes& boxes) {
  return CrossingSearch(mesh, pieces, boxes).find();
}

}  // namespace nearfit
