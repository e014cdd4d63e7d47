#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/cull_kernel.h"
#include "core/proximity/leaf_pair.h"
#include "core/proximity/normal_cone_tree.h"

namespace nearfit {

/// Four pairs of edges, lane by lane, each edge in the centred frame of its own tree, with what a test of it
/// needs at any pose.
struct alignas(64) EdgePairs {
  static constexpr std::size_t kLanes = 4;

  using Numbers = std::array<double, kLanes>;
  using Vectors = std::array<Numbers, 3>;
  struct Edges {
    Vectors start, along;  ///< `along` is unit.
    Numbers length;        ///< [m]
    /// From the edge, square to it, to the third corner of either face; the lengths of both.
    std::array<Vectors, 2> inward;
    std::array<Numbers, 2> depth;
  };
  Edges scene, part;
};

/// What pairs of edges are held against: LeafTests' bounds and tolerances, with relaxed directions.
struct EdgePairLimits {
  double cutoff = 0.0, mostDistance = 0.0;  ///< [m]
  double lengthTolerance = 0.0;             ///< [m]
  double angularSlack = 0.0;                ///< [rad]
  double pointRounding = 0.0;               ///< [m]
};

/// What became of four pairs: bit per lane.
struct EdgePairHits {
  std::uint32_t found = 0;
  /// Nearly parallel, or not to be told: LeafTests decides.
  std::uint32_t undecided = 0;
  EdgePairs::Vectors partPoint, direction;  ///< In the scene's centred frame, where found.
  EdgePairs::Numbers distance;              ///< [m]
};

/// Tests four pairs of edges that cross: what LeafTests says of each alone, to the last bit, since it is the
/// same arithmetic in the same order. Real-time safe.
using EdgePairKernel = void (*)(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
                                const RigidTransform& partFromScene, const EdgePairLimits& limits,
                                EdgePairHits& out) noexcept;

/// The kernel for a level that the machine has.
EdgePairKernel edgePairKernel(SimdLevel level) noexcept;

/// Pairs that are tested four at a time, and by what.
struct PackedEdgePairs {
  std::span<const EdgePairs> blocks;
  EdgePairKernel kernel = nullptr;  ///< Not null where there are blocks.
};

/// Puts pairs of edges first and makes blocks of them, as many as there is room for: the first
/// EdgePairs::kLanes pairs are the first block, and so on. What does not fill a block is left as it is.
/// @returns how many blocks were filled.
/// Real-time safe.
std::size_t packEdgePairs(const NormalConeTree& scene, const NormalConeTree& part, std::span<LeafPair> pairs,
                          std::span<EdgePairs> blocks) noexcept;

}  // namespace nearfit
