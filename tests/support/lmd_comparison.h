#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/math/rigid_transform.h"
#include "core/mesh/triangle_mesh.h"
#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/lmd.h"

/// Comparison of the engine's sets with those of the brute-force oracle; differences are reported to
/// GoogleTest.
namespace nearfit::test {

struct BodyPair {
  std::string name;
  TriangleMesh scene, part;
};

/// Counts of a comparison, so that a test can ask that it compared anything.
struct LmdTally {
  std::size_t poses = 0;
  std::size_t minima = 0;    ///< That rounding cannot add or take away.
  std::size_t marginal = 0;  ///< Others.
  std::size_t regions = 0;
};

/// The complete set; fails the test when the query says it is truncated.
std::vector<Lmd> allLmds(const NormalConeTree& scene, const NormalConeTree& part,
                         const RigidTransform& sceneFromPart, double cutoff);

RigidTransform randomRotation(std::mt19937_64& random);

/// A random vertex of the part lies within `reach` of a random vertex of the scene, at any orientation: near
/// contact, with the bodies interpenetrating elsewhere as often as not.
RigidTransform poseNearContact(const BodyPair& pair, double reach, std::mt19937_64& random);

/// A random face of the part faces a random one of the scene, parallel but for `tilt` [rad] about any axis,
/// with a corner of one over the other at a gap from a tenth of `reach` to all of it.
RigidTransform poseWithParallelFaces(const BodyPair& pair, double reach, double tilt,
                                     std::mt19937_64& random);

/// Compares at a pose: minima as below, and regions by their dimension, centroid, measure and distance.
void compareAtPose(const BodyPair& pair, const RigidTransform& pose, double cutoff, LmdTally& tally);

/// Compares at random poses near contact: each certain minimum of the oracle is found once, each found one is
/// the oracle's (marginal or not). Points to 1e-9 of the scene's diagonal.
/// @param cutoffFraction  Of the larger body's diagonal.
LmdTally compareWithOracle(const BodyPair& pair, std::size_t poses, double cutoffFraction,
                           std::uint64_t seed);

}  // namespace nearfit::test
