#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/lmd.h"
#include "core/proximity/query/cull_kernel.h"

namespace nearfit {

class NormalConeTree;

/// Two bodies, the pose of one in the other's frame, and the max distance of interest. Refers to the
/// hierarchies, which the caller keeps alive.
struct BodyPairQuery {
  const NormalConeTree &scene, &part;
  RigidTransform sceneFromPart;
  double cutoff;  ///< [m]
};

/// How complete a result is.
enum class QueryStatus : std::uint8_t {
  Complete,   ///< The exact set.
  Truncated,  ///< Room or work ran out; the nearest minima found are there.
};

/// Result of a query; the minima are in the caller's storage.
struct LmdResult {
  std::size_t count = 0;  ///< Number of filled entries of the caller's storage.
  QueryStatus status = QueryStatus::Complete;
  /// Every minimum nearer than this is there [m]: the cutoff if Complete, else less.
  double completeTo = 0.0;
  std::uint64_t nodePairs = 0;   ///< Node pairs visited; with a candidate list, blocks of pairs culled.
  std::uint64_t leafPairs = 0;   ///< Feature pairs tested exactly.
  std::size_t pieces = 0;        ///< Minima and pieces of regions found, before merging.
  std::uint64_t piecePairs = 0;  ///< Pairs of these near enough to be compared for merging.
};

/// Work space of a query, allocated once; one per thread.
class LmdScratch {
 public:
  /// Room for the minima of a servo tick. A query that finds more keeps the nearest and returns Truncated.
  static constexpr std::size_t kDefaultCapacity = 16384;

  /// @param capacity  Max number of minima and region pieces that a query holds; about 750 bytes each.
  /// @param simd      Instruction set for culling; results do not depend on it.
  explicit LmdScratch(std::size_t capacity = kDefaultCapacity, SimdLevel simd = defaultSimdLevel());
  ~LmdScratch();
  LmdScratch(LmdScratch&&) noexcept;
  LmdScratch& operator=(LmdScratch&&) noexcept;

  /// Limits later queries to this many minima and region pieces (clamped to between one and the capacity), as
  /// if it were the capacity. This bounds the time of merging, which can take longest. Real-time safe.
  void holdAtMost(std::size_t pieces) noexcept;

  /// Internal to core/proximity.
  struct Data;
  Data& data() noexcept { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// Finds the local minimum distances between two bodies, nearest first.
///
/// @param scene, part    Hierarchies of the two meshes.
/// @param sceneFromPart  Pose of `part` in the frame of `scene`; unit quaternion.
/// @param cutoff         Ignore pairs farther apart than this [m]; finite, > 0.
/// @param scratch        Preallocated work space, one per thread.
/// @param out            Caller's storage; keeps the nearest if it fills, and the result says Truncated.
/// @param maxNodePairs   Bound on the work, in pairs of nodes and of features, exceeded by one batch at most.
///                       At the bound the result is Truncated and holds what was found.
/// Points are in scene's frame. Real-time safe: no allocation, lock or throw. An empty hierarchy, a pose that
/// is not finite or an invalid cutoff gives no minima.
///
/// Guarantee: a Complete result holds each minimum of the exact geometry once, and each entry meets the exact
/// conditions to the tolerances of tolerances.h (directions to 1e-10 rad, lengths to 1e-12 of the bodies'
/// size, neither finer than the rounding of coordinates; faces and edges parallel to within 1e-6 rad form one
/// region). It holds for bodies of 1e-6 to 1e6 m, up to a million sizes from the origin, slivers of up to
/// 1e6, distances from 1e-13 of the size: resources/docs/accuracy.md. Outside that range the set may be wrong
/// or empty. Source: Johnson & Willemsen 2003, 4.2; exact leaf conditions instead of vertex-normal spans.
LmdResult findLmds(const NormalConeTree& scene, const NormalConeTree& part,
                   const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                   std::span<Lmd> out,
                   std::uint64_t maxNodePairs = std::numeric_limits<std::uint64_t>::max()) noexcept;

/// As findLmds, with bounded work however near the bodies are. If the whole set takes more than half of the
/// bound, the rest of the work goes to the nearest minimum. The result is then Truncated: it holds the
/// nearest minimum (`completeTo` is its distance, or 0 if even that took too long) and others found before.
LmdResult findNearestLmds(const NormalConeTree& scene, const NormalConeTree& part,
                          const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                          std::span<Lmd> out, std::uint64_t maxNodePairs) noexcept;

}  // namespace nearfit
