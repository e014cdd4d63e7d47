#pragma once

#include <string>
#include <vector>

#include "tests/support/lmd_comparison.h"

namespace nearfit::stress {

/// Twenty pairs of small meshes: ordinary ones, and those that are hard on arithmetic or are no solids. The
/// last four are of files that came from elsewhere where these are, of generated meshes where not.
std::vector<test::BodyPair> oraclePairs();

}  // namespace nearfit::stress
