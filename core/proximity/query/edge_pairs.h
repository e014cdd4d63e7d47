#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/cull_kernel.h"
#include "core/proximity/query/leaf_pair.h"

namespace nearfit {

/// Four pairs of edges, one per lane, with what their tests need at any pose. Each edge is in the centred
/// frame of its own tree.
struct alignas(64) EdgePairs {
  static constexpr std::size_t kLanes = 4;

  using Numbers = std::array<double, kLanes>;
  using Vectors = std::array<Numbers, 3>;
  struct Edges {
    Vectors start, along;  ///< `along` is unit.
    Numbers length;        ///< [m]
    /// Vectors from the edge, perpendicular to it, to the third corner of each face, and their lengths [m].
    std::array<Vectors, 2> inward;
    std::array<Numbers, 2> depth;
  };
  Edges scene, part;
};

/// Limits for tests of edge pairs: the bounds and tolerances of LeafTests, with relaxed directions.
struct EdgePairLimits {
  double cutoff = 0.0, mostDistance = 0.0;  ///< [m]
  double lengthTolerance = 0.0;             ///< [m]
  double angularSlack = 0.0;                ///< [rad]
  double pointRounding = 0.0;               ///< [m]
};

/// Results of testing four pairs; one bit per lane.
struct EdgePairHits {
  std::uint32_t found = 0;
  /// Lanes whose edges are nearly parallel or not finite: LeafTests decides.
  std::uint32_t undecided = 0;
  EdgePairs::Vectors partPoint, direction;  ///< In the scene's centred frame; valid in lanes found.
  EdgePairs::Numbers distance;              ///< [m]
};

/// Tests four pairs of edges that cross. Results equal those of LeafTests for each pair to the last bit,
/// since the arithmetic and its order are the same. Real-time safe.
using EdgePairKernel = void (*)(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
                                const RigidTransform& partFromScene, const EdgePairLimits& limits,
                                EdgePairHits& out) noexcept;

/// Returns the kernel for an instruction set that the machine has.
EdgePairKernel edgePairKernel(SimdLevel level) noexcept;

/// Blocks of pairs to test four at a time, and the kernel that tests them.
struct PackedEdgePairs {
  std::span<const EdgePairs> blocks;
  EdgePairKernel kernel = nullptr;  ///< Not null if there are blocks.
};

/// Moves pairs of edges to the front. Returns their number. Real-time safe.
std::size_t edgePairsToFront(std::span<LeafPair> pairs) noexcept;

/// Packs a block of pairs of edges. Real-time safe.
void packEdgePairs(const NormalConeTree& scene, const NormalConeTree& part,
                   std::span<const LeafPair, EdgePairs::kLanes> pairs, EdgePairs& block) noexcept;

}  // namespace nearfit
