#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/cull_kernel.h"
#include "core/proximity/query/lane_vectors.h"
#include "core/proximity/query/leaf_pair.h"
#include "core/proximity/query/segment_pairs.h"

namespace nearfit {

/// Eight pairs of edges, one per lane, by their corners: the ends of each edge, and the third corners of its faces, in the
/// centred frame of its own tree [m].
struct alignas(64) EdgePairCorners {
  SegmentPairs ends;
  std::array<LaneVectors, 2> sceneOpposite, partOpposite;
};

/// Eight pairs of edges, one per lane, with what their tests need at any pose. Each edge is in the centred
/// frame of its own tree.
struct alignas(64) EdgePairs {
  static constexpr std::size_t kLanes = kPairLanes;

  struct Edges {
    LaneVectors start, along;  ///< `along` is unit.
    LaneNumbers length;        ///< [m]
    /// LaneVectors from the edge, perpendicular to it, to the third corner of each face, and their lengths [m].
    std::array<LaneVectors, 2> inward;
    std::array<LaneNumbers, 2> depth;
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

/// Results of testing eight pairs; one bit per lane.
struct EdgePairHits {
  std::uint32_t found = 0;
  /// Lanes whose edges are nearly parallel or not finite: LeafTests decides.
  std::uint32_t undecided = 0;
  LaneVectors partPoint, direction;  ///< In the scene's centred frame; valid in lanes found.
  LaneNumbers distance;              ///< [m]
};

/// Kernels for eight pairs of edges. Results equal those of LeafTests for each pair to the last bit,
/// since the arithmetic and its order are the same. Real-time safe.
struct EdgePairKernels {
  void (*pack)(const EdgePairCorners& corners, EdgePairs& out) noexcept = nullptr;
  /// Tests pairs of edges that cross.
  void (*test)(const EdgePairs& pairs, const RigidTransform& sceneFromPart,
               const RigidTransform& partFromScene, const EdgePairLimits& limits,
               EdgePairHits& out) noexcept = nullptr;
};

/// Returns the kernels for an instruction set that the machine has.
EdgePairKernels edgePairKernels(SimdLevel level) noexcept;

/// Blocks of pairs to test eight at a time, and the kernels that test them.
struct PackedEdgePairs {
  std::span<const EdgePairs> blocks;
  EdgePairKernels kernels{};  ///< Not null if there are blocks.
};

/// True if both features of a pair are edges.
bool isOfEdges(const LeafPair& pair) noexcept;

/// Moves pairs of edges to the front. Returns their number. Real-time safe.
std::size_t edgePairsToFront(std::span<LeafPair> pairs) noexcept;

/// Packs a block of pairs of edges. Real-time safe.
void packEdgePairs(const NormalConeTree& scene, const NormalConeTree& part,
                   std::span<const LeafPair, EdgePairs::kLanes> pairs, const EdgePairKernels& kernels,
                   EdgePairs& block) noexcept;

}  // namespace nearfit
