#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/cull_kernel.h"
#include "core/proximity/query/edge_pairs.h"
#include "core/proximity/query/lane_vectors.h"
#include "core/proximity/query/leaf_pair.h"

namespace nearfit {

/// Eight pairs of a face and a vertex, one per lane; the faces are of one body, the vertices of the other. Each is in the
/// centred frame of its own tree [m].
struct alignas(64) FacePairs {
  static constexpr std::size_t kLanes = kPairLanes;

  std::array<LaneVectors, 3> corners;
  LaneVectors vertex;
};

/// Packs pairs of a face and a vertex.
/// @param facesArePart  The faces are of the part, else of the scene.
/// Real-time safe.
void packFacePairs(const NormalConeTree& scene, const NormalConeTree& part,
                   std::span<const LeafPair, FacePairs::kLanes> pairs, bool facesArePart,
                   FacePairs& block) noexcept;

/// Results of the part of LeafTests that concerns the faces: it comes before the vertices' edges.
struct FacePairHits {
  std::uint32_t over = 0;  ///< Lanes whose vertex is over its face, and within the cutoff; one bit per lane.
  LaneVectors vertex, normal;  ///< In the faces' frame; `normal` is unit.
  LaneNumbers distance;        ///< [m]
  LaneNumbers tilt;            ///< Error of the face's normal [rad].
};

/// How the pairs are apart, as directionsOf() and separationAlong() tell, in the faces' frame.
struct FaceSeparations {
  LaneVectors apart;   ///< From the face to the vertex, unit; zero without a distance.
  LaneVectors normal;  ///< Unit; zero for a face without an area.
  LaneVectors vertex;
  LaneNumbers distance, height;  ///< `height`: how far the face reaches along `apart` [m].
};

/// Kernels for eight pairs.
/// @param faceFromVertex  Between the trees' centred frames.
/// Real-time safe.
struct FacePairKernels {
  /// The part of LeafTests::test with relaxation that concerns the faces, equal to it to the last bit.
  void (*test)(const FacePairs& pairs, const RigidTransform& faceFromVertex, const EdgePairLimits& limits,
               FacePairHits& out) noexcept = nullptr;
  void (*separate)(const FacePairs& pairs, const RigidTransform& faceFromVertex,
                   FaceSeparations& out) noexcept = nullptr;
};

/// Returns the kernels for an instruction set that the machine has.
FacePairKernels facePairKernels(SimdLevel level) noexcept;

}  // namespace nearfit
