#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/cull_kernel.h"
#include "core/proximity/lmd.h"

namespace nearfit {

class NormalConeTree;

/// Between two bodies: where one stands in the frame of the other, and what is looked for there.
struct BodyPairQuery {
  const NormalConeTree &scene, &part;
  RigidTransform sceneFromPart;
  double cutoff;  ///< [m]
};

enum class QueryStatus : std::uint8_t {
  Complete,   ///< The exact set.
  Truncated,  ///< More minima than there was room for, or more work than allowed: the nearest found are
              ///< there.
};

struct LmdResult {
  std::size_t count = 0;  ///< Entries of the caller's storage that were filled.
  QueryStatus status = QueryStatus::Complete;
  /// Every minimum nearer than this is there [m]: the cutoff when Complete, less when Truncated.
  double completeTo = 0.0;
  std::uint64_t nodePairs = 0;   ///< Node pairs visited; of a list, blocks of pairs that were culled.
  std::uint64_t leafPairs = 0;   ///< Feature pairs tested exactly.
  std::size_t pieces = 0;        ///< Minima and pieces of regions that were merged.
  std::uint64_t piecePairs = 0;  ///< Of them, those near enough to be held against each other.
};

/// Work space of a query, allocated once; one per thread.
class LmdScratch {
 public:
  /// Room for the minima of a servo tick: a query that finds more keeps the nearest and says Truncated.
  static constexpr std::size_t kDefaultCapacity = 16384;

  /// @param capacity  Minima, and pieces of flat regions, that a query can hold; about 750 bytes each.
  /// @param simd      Instruction set to cull with; the sets are the same with each.
  explicit LmdScratch(std::size_t capacity = kDefaultCapacity, SimdLevel simd = defaultSimdLevel());
  ~LmdScratch();
  LmdScratch(LmdScratch&&) noexcept;
  LmdScratch& operator=(LmdScratch&&) noexcept;

  /// From now on a query holds no more than so many minima and pieces (at least one, at most the capacity),
  /// as if that were the capacity: merging them is what can take longest. Real-time safe.
  void holdAtMost(std::size_t pieces) noexcept;

  struct Data;
  Data& data() noexcept { return *data_; }

 private:
  std::unique_ptr<Data> data_;
};

/// Local minimum distances between two bodies, nearest first.
///
/// @param scene, part    Hierarchies of the two meshes.
/// @param sceneFromPart  Pose of `part` in the frame of `scene`; unit quaternion.
/// @param cutoff         Ignore pairs farther apart than this [m]; finite, > 0.
/// @param scratch        Preallocated work space, one per thread.
/// @param out            Caller's storage; keeps the nearest if it fills, and the result says Truncated.
/// @param maxNodePairs   Bound on the work, in pairs of nodes and of features (beyond it by one batch of
///                       them at most): at it the result says Truncated and holds what was found.
/// Points are in scene's frame. Real-time safe: no allocation, lock or throw.
///
/// Promised: each minimum of the exact geometry is there, once; each entry meets the exact conditions to the
/// tolerances of tolerances.h (directions to 1e-10 rad, lengths to 1e-12 of the bodies' size, both no better
/// than the rounding of coordinates allows; faces and edges parallel to 1e-6 rad are one region). For bodies
/// of 1e-6 to 1e6 m, up to a million sizes from the origin, slivers of up to 1e6, distances from 1e-13 of the
/// size: resources/docs/accuracy.md. Beyond that, and for arguments that are no numbers, the set may be wrong
/// or empty. Source: Johnson & Willemsen 2003, 4.2; exact leaf conditions instead of vertex-normal spans.
LmdResult findLmds(const NormalConeTree& scene, const NormalConeTree& part,
                   const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                   std::span<Lmd> out,
                   std::uint64_t maxNodePairs = std::numeric_limits<std::uint64_t>::max()) noexcept;

/// The same with bounded work, however near the bodies are: when the whole set takes more than half of it,
/// the rest is for what is nearest. The result is then Truncated: it holds the nearest minimum (`completeTo`
/// is its distance, or 0 when even that took too long) and others that were found.
LmdResult findNearestLmds(const NormalConeTree& scene, const NormalConeTree& part,
                          const RigidTransform& sceneFromPart, double cutoff, LmdScratch& scratch,
                          std::span<Lmd> out, std::uint64_t maxNodePairs) noexcept;

}  // namespace nearfit
