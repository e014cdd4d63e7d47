#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/proximity/minimum.h"
#include "core/proximity/query/cull_kernel.h"
#include "core/proximity/query/lmd_query.h"
#include "core/proximity/query/merge_minima.h"
#include "core/proximity/query/segment_kernel.h"
#include "core/proximity/query/tree_traversal.h"

namespace nearfit {

/// A search for the nearest minimum alone culls at its distance times this: culls round, and an equally near
/// minimum must not be lost.
constexpr double kNearestSlack = 1.0 + 1e-6;

/// Contents of an LmdScratch: the traversal's stack, and the minima found, until they are merged.
struct LmdScratch::Data {
  Data(std::size_t capacity, SimdLevel simd)
      : room(capacity),
        minima(capacity),
        order(capacity),
        merge(capacity),
        open(opener(simd)),
        openSwept(sweptOpener(simd)),
        openContacts(contactOpener(simd)),
        openSweptContacts(sweptContactOpener(simd)),
        openNear(nearOpener(simd)),
        pairCull(pairCullKernel(simd)),
        sweptPairCull(sweptPairCullKernel(simd)),
        segmentCull(segmentKernel(simd)) {}

  TraversalWork traversal;
  std::size_t room;  ///< Number of `minima` that a query may use.
  std::vector<Minimum> minima;
  std::vector<std::uint32_t> order;
  MergeWork merge;
  Opener open, openSwept, openContacts, openSweptContacts, openNear;
  PairCullKernel pairCull;
  SweptPairCullKernel sweptPairCull;
  SegmentKernel segmentCull;
};

/// Collects minima as they are found, keeping the nearest if the workspace is full, and merges them at the
/// end. Real-time safe.
class MinimaCollector {
 public:
  MinimaCollector(LmdScratch::Data& workspace, LmdResult& result) noexcept
      : workspace_(workspace), minima_(std::span(workspace.minima).first(workspace.room)), result_(result) {}

  /// Storage for the next minimum; add() takes it in.
  Minimum& slot() noexcept { return count_ < minima_.size() ? minima_[count_] : spare_; }
  void add() noexcept;

  /// Merges, sorts nearest first, and writes to `out` in the frame of the scene's mesh. Completes the result;
  /// if minima were dropped, sets Truncated and lowers completeTo.
  void finish(const NormalConeTree& scene, const NormalConeTree& part, std::span<Lmd> out) noexcept;

 private:
  LmdScratch::Data& workspace_;
  std::span<Minimum> minima_;
  LmdResult& result_;
  Minimum spare_;
  std::size_t count_ = 0;
  bool isHeap_ = false;
};

/// Converts a pose between the meshes' frames to one between the trees' centred frames, and normalises it.
/// Far from the origin it computes in extended precision.
RigidTransform centredPose(const NormalConeTree& scene, const NormalConeTree& part,
                           const RigidTransform& sceneFromPart) noexcept;

/// Returns cutoff and padding, in single precision, for a pose between the centred frames.
CullLimits cullLimits(const NormalConeTree& scene, const NormalConeTree& part, const RigidTransform& centred,
                      double cutoff) noexcept;

/// True if both hierarchies hold features, the pose is finite, and the cutoff is a normal number > 0. A query
/// has no minima otherwise.
bool isQueryValid(const NormalConeTree& scene, const NormalConeTree& part,
                  const RigidTransform& sceneFromPart, double cutoff) noexcept;

}  // namespace nearfit
