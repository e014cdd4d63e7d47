#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/math/rigid_transform.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/query/cull_kernel.h"
#include "core/proximity/query/edge_pairs.h"
#include "core/proximity/query/leaf_pair.h"

namespace nearfit {

/// Eight pairs of a face and a vertex, one per lane; the faces are of one body, the vertices of the other. Each is in the
/// centred frame of its own tree [m].
struct alignas(64) FacePairs {
  static constexpr std::size_t kLanes = EdgePairs::kLanes;
  using Numbers = EdgePairs::Numbers;
  using Vectors = EdgePairs::Vectors;

  std::array<Vectors, 3> corners;
  Vectors vertex;
};

/// Packs pairs of a face and a vertex.
/// @param facesArePart  The faces are of the part, else of the scene.
/// Real-time safe.
void packFacePairs(const NormalConeTree& scene, const NormalConeTree& part,
                   std::span<const LeafPair, FacePairs::kLanes> pairs, bool facesArePart,
                   FacePairs& block) noexcept;

/// What LeafTests finds of the faces before it looks at the vertices' edges.
struct FacePairHits {
  std::uint32_t over = 0;  ///< Lanes whose vertex is over its face, and within the cutoff; one bit per lane.
  FacePairs::Vectors vertex, normal;  ///< In the faces' frame; `normal` is unit.
  FacePairs::Numbers distance;        ///< [m]
  FacePairs::Numbers tilt;            ///< Error of the face's normal [rad].
};

/// How the pairs are apart, as directionsOf() and separationAlong() tell, in the faces' frame.
struct FaceSeparations {
  FacePairs::Vectors apart;   ///< From the face to the vertex, unit; zero without a distance.
  FacePairs::Vectors normal;  ///< Unit; zero for a face without an area.
  FacePairs::Vectors vertex;
  FacePairs::Numbers distance, height;  ///< `height`: how far the face reaches along `apart` [m].
};

/// What is done with eight pairs at a time.
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
