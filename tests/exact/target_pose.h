#pragma once

#include <random>

#include "core/math/rigid_transform.h"
#include "tests/support/lmd_comparison.h"

namespace nearfit::test {

/// A pose at which a minimum is likely and likely to be a close call: a point of the part stands over a point
/// of the scene at up to `reach`, along a mix of face normals around either; points and mixes lie on a
/// feature or off it by random powers of ten.
RigidTransform targetPose(const BodyPair& pair, double reach, std::mt19937_64& random);

/// One body rests with its axes along the other's, corner near corner, where flat contacts are exact.
RigidTransform alignedPose(const BodyPair& pair, double reach, std::mt19937_64& random);

}  // namespace nearfit::test
