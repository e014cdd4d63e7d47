#pragma once

#include <array>
#include <vector>

#include <glm/vec3.hpp>

#include "core/math/rigid_transform.h"
#include "tests/support/lmd_oracle.h"

/// Flat regions by brute force over all pairs of faces and edges: parallel to a microradian, facing each
/// other. Shares nothing with the engine: overlaps are hulls of crossings, what they cover together is
/// measured slab by slab.
namespace nearfit::test {

struct OracleRegion {
  int dimension;                                ///< 1 of edges, 2 of faces.
  glm::dvec3 centroid;                          ///< On the scene's side, in the scene's frame.
  glm::dvec3 direction;                         ///< Out of the scene.
  double measure, least;                        ///< Length or area; least distance.
  std::vector<std::vector<glm::dvec3>> pieces;  ///< Convex, on the scene's side.
};

std::vector<OracleRegion> bruteForceRegions(const OracleBody& scene, const OracleBody& part,
                                            const RigidTransform& sceneFromPart, double cutoff);

/// Whether a minimum lies in a region or at its rim: the region stands for it.
bool isOfRegion(const OracleMinimum& minimum, const OracleRegion& region, double tolerance);

}  // namespace nearfit::test
