#pragma once

#include <cstdint>
#include <vector>

#include "core/proximity/hierarchy/normal_cone_tree.h"
#include "core/proximity/minimum.h"
#include "core/proximity/query/touching.h"

/// The grouping of minima by brute force: every two are held against each other.
namespace nearfit::test {

/// What the leaf tests find in all pairs of features of two bodies, before it is merged; in the frame of the
/// hierarchies.
std::vector<Minimum> unmergedMinima(const NormalConeTree& scene, const NormalConeTree& part,
                                    const RigidTransform& sceneFromPart, double cutoff);

/// Of each entry the first of its set, sets being the transitive closure of touching. Marks those that
/// overlap. O(n^2).
std::vector<std::uint32_t> setsByAllPairs(std::vector<Minimum>& minima, const TouchTolerances& closeness);

}  // namespace nearfit::test
