#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/proximity/cull_kernel.h"
#include "core/proximity/lmd_query.h"
#include "core/proximity/merge_minima.h"
#include "core/proximity/minimum.h"
#include "core/proximity/segment_kernel.h"
#include "core/proximity/tree_traversal.h"

namespace nearfit {

/// A search that goes on for the nearest alone culls by its distance and this much: culls round, and what is
/// as near must not be lost.
constexpr double kNearestSlack = 1.0 + 1e-6;

/// What an LmdScratch holds: the stack of a traversal, and the minima found until they are merged.
struct LmdScratch::Data {
  Data(std::size_t capacity, SimdLevel simd)
      : room(capacity),
        minima(capacity),
        order(capacity),
        merge(capacity),
        open(opener(simd)),
        openSwept(sweptOpener(simd)),
        openNear(nearOpener(simd)),
        pairCull(pairCullKernel(simd)),
        sweptPairCull(sweptPairCullKernel(simd)),
        segmentCull(segmentKernel(simd)) {}

  TraversalWork traversal;
  std::size_t room;  ///< Of `minima` that a query may use.
  std::vector<Minimum> minima;
  std::vector<std::uint32_t> order;
  MergeWork merge;
  Opener open, openSwept, openNear;
  PairCullKernel pairCull;
  SweptPairCullKernel sweptPairCull;
  SegmentKernel segmentCull;
};

/// Takes minima in as they are found, keeps the nearest when the workspace is full, and merges them in the
/// end.
class MinimaCollector {
 public:
  MinimaCollector(LmdScratch::Data& workspace, LmdResult& result) noexcept
      : workspace_(workspace), minima_(std::span(workspace.minima).first(workspace.room)), result_(result) {}

  /// Where to write the next one; add() takes it in.
  Minimum& slot() noexcept { return count_ < minima_.size() ? minima_[count_] : spare_; }
  void add() noexcept;

  /// Merges, sorts nearest first, and writes to `out` in the frame of the scene's mesh.
  void finish(const NormalConeTree& scene, const NormalConeTree& part, std::span<Lmd> out) noexcept;

 private:
  LmdScratch::Data& workspace_;
  std::span<Minimum> minima_;
  LmdResult& result_;
  Minimum spare_;
  std::size_t count_ = 0;
  bool isHeap_ = false;
};

/// A pose between the trees' centred frames from one between the meshes' frames, its quaternion normalised.
RigidTransform centredPose(const NormalConeTree& scene, const NormalConeTree& part,
                           const RigidTransform& sceneFromPart) noexcept;

/// Cutoff and padding in single precision for a pose between centred frames.
CullLimits cullLimits(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& centred,
                      double cutoff) noexcept;

/// Whether a query with these arguments makes sense; it has no minima otherwise.
bool isQueryValid(const NormalConeTree& scene, const NormalConeTree& part,
                  const RigidTransform& sceneFromPart, double cutoff) noexcept;

}  // namespace nearfit
