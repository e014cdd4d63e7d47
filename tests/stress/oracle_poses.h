#pragma once

#include <random>

#include "core/math/rigid_transform.h"
#include "tests/support/lmd_comparison.h"

namespace nearfit::stress {

/// What a pose is meant for.
enum class PoseKind {
  Random,    ///< Near contact, at any orientation.
  Lattice,   ///< Turned by multiples of 45 degrees, points of either exactly above one another.
  Aligned,   ///< Axes along each other, corner near corner.
  Target,    ///< A point stands over a point on, or by a power of ten off, a feature.
  Parallel,  ///< Faces face each other, or are tilted by about as much as still counts as parallel.
};

struct OraclePose {
  PoseKind kind;
  RigidTransform sceneFromPart;
};

/// Seven of ten are random.
OraclePose randomOraclePose(const test::BodyPair& pair, double reach, std::mt19937_64& random);

}  // namespace nearfit::stress
